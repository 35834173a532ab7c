// A stage as a drawing over the particles: nodes with their mass and motion, and what the picked
// particle and its nodes give each other.

const NODE = 0.17;  // radius of the heaviest node [cells]
const BARE = 3;  // that of a node without mass [pixels]
const LABELED = 44;  // pixels: a cell at whose nodes there is room for a number
const FARTHEST = 1.5;  // cells: nodes that are drawn farther off are no part of the moved grid

class Sketch {
  constructor(theme) {
    this.colors = { ...theme.css, picked: "#f2a63a" };
  }

  draw(pen, camera, moment) {
    const { name, mine, x, step, dt, larger, isStill } = moment;
    const at = (place, by = [0, 0]) =>
      camera.look([...place.map((entry, axis) => entry + larger * by[axis]), 0]).slice(0, 2);
    const away = (place, v) => at(place, v.map(entry => entry * dt));
    Object.assign(this, { pen, cell: moment.dx * camera.scale });
    this.drawNodes(moment, camera, at, away);
    const seat = node => moment.isGridMoved ? away(node.x, node.v) : at(node.x);
    const [from, to] = [at(x), at(x, step)];
    this.arrow(from, to, 2, this.colors.picked, 0);
    for (const node of mine) {
      const gives = name == "particles to nodes", takes = name == "nodes to particles";
      if (!gives && !takes) continue;
      pen.globalAlpha = Math.min(1, 0.35 + 2 * node.w);
      this.arrow(...(gives ? [from, seat(node)] : [seat(node), to]), 1 + 5 * node.w,
        this.colors.picked, 7);
    }
    pen.globalAlpha = 1;
    this.disc(to, 6, this.colors.picked);
    if (isStill || this.cell < LABELED) return;
    for (const node of mine) this.label([weight(node.w), node.place.join(", ")], seat(node), to);
  }

  /** Discs whose area is the mass, rings of nodes without; arrows of their motion, and the lines of
   *  the grid that moves with them. */
  drawNodes(moment, camera, at, away) {
    const { pen, colors, cell } = this, { nodes, dx, dt, name, larger, isGridMoved } = moment;
    const mine = new Set(moment.mine.map(({ i }) => i));
    const seats = Array.from(nodes.mass, (_, i) => {
      const x = nodes.placeOf(i).map(entry => entry * dx), v = moment.velocityOf(i), home = at(x);
      const isFar = Math.hypot(...v) * dt * larger > FARTHEST * dx;
      const isSeen = home[0] > -cell && home[0] < camera.width + cell
        && home[1] > -cell && home[1] < camera.height + cell;
      return { home, away: away(x, v), isFar, isSeen };
    });
    if (isGridMoved) {
      pen.strokeStyle = colors.faintInk;
      pen.globalAlpha = 0.45;
      pen.lineWidth = 1;
      pen.beginPath();
      for (let i = 0; i < nodes.count; i++)
        for (const [right, up] of [[1, 0], [0, 1]]) {
          const [a, b] = nodes.placeOf(i), other = nodes.at([a + right, b + up]);
          if (other === undefined || seats[i].isFar || seats[other].isFar) continue;
          pen.moveTo(...seats[i].away);
          pen.lineTo(...seats[other].away);
        }
      pen.stroke();
    }
    seats.forEach(({ home, away, isFar, isSeen }, i) => {
      if (!isSeen) return;
      const mass = moment.isStill ? 0 : nodes.mass[i];
      const radius = mass > 0 ? Math.max(NODE * cell * Math.sqrt(mass / nodes.heaviest), 1.5) : BARE;
      const seat = isGridMoved && !isFar ? away : home;
      pen.globalAlpha = mine.has(i) ? 1 : 0.4;
      if ((name == "grid update" || name == "stress") && !isFar)
        this.arrow(home, away, 2, colors.ink, isGridMoved ? radius : 0);
      if (isGridMoved && !isFar) this.ring(home, 2);
      if (mass > 0) this.disc(seat, radius, colors.ink);
      else this.ring(seat, radius);
    });
    pen.globalAlpha = 1;
  }

  disc([column, row], radius, color) {
    const { pen, colors } = this;
    pen.beginPath();
    pen.arc(column, row, radius, 0, 2 * Math.PI);
    pen.fillStyle = color;
    pen.fill();
    pen.strokeStyle = colors.background;
    pen.lineWidth = 1;
    pen.stroke();
  }

  ring([column, row], radius) {
    const { pen, colors } = this;
    pen.beginPath();
    pen.arc(column, row, radius, 0, 2 * Math.PI);
    pen.strokeStyle = colors.ink;
    pen.lineWidth = 1;
    pen.stroke();
  }

  /** From a to b, so many pixels before it; none where that leaves nothing. */
  arrow(a, b, width, color, before) {
    const { pen } = this, [across, down] = [b[0] - a[0], b[1] - a[1]];
    const length = Math.hypot(across, down), head = Math.min(5 + 1.5 * width, 0.6 * length);
    if (length < before + 4) return;
    const along = (far, beside) => [
      a[0] + (across * far - down * beside) / length, a[1] + (down * far + across * beside) / length,
    ];
    const tip = length - before;
    pen.strokeStyle = pen.fillStyle = color;
    pen.lineWidth = width;
    pen.beginPath();
    pen.moveTo(...along(0, 0));
    pen.lineTo(...along(tip - head, 0));
    pen.stroke();
    pen.beginPath();
    for (const corner of [[tip, 0], [tip - head, head / 2], [tip - head, -head / 2]])
      pen.lineTo(...along(...corner));
    pen.fill();
  }

  /** Weight and name of a node, on its side away from the particle. */
  label(lines, [column, row], from) {
    const { pen, colors } = this, [across, down] = [column - from[0], row - from[1]];
    const away = Math.hypot(across, down), off = NODE * this.cell + 16;
    const [right, below] = away > 1 ? [across / away, down / away] : [0, -1];
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.lineJoin = "round";
    pen.lineWidth = 4;
    pen.strokeStyle = colors.background;
    lines.forEach((words, number) => {
      const place = [column + (off + 6) * right, row + off * below + 13 * (number - 0.5)];
      pen.font = number == 0 ? "600 12px system-ui, sans-serif" : "11px system-ui, sans-serif";
      pen.fillStyle = number == 0 ? colors.picked : colors.faintInk;
      pen.strokeText(words, ...place);
      pen.fillText(words, ...place);
    });
  }
}
