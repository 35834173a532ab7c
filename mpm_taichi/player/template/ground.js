// What lies under and over the particles: the domain, its grid with the numbers of the cells, its
// walls; the scale bar and the picked particle.

const FINEST = 7;  // pixels between lines; of a finer grid each second, fifth, tenth ... is drawn
const ROUND = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000];
const ROOMY = 44, SMALL = 11;  // pixels: a cell that holds its numbers, their size

class Ground {
  constructor(film, theme) {
    Object.assign(this, { theme, dim: film.dimension, ...film.domain });  // size, cells, walls
    this.plane = this.dim == 2 ? [0, 1] : [0, 2];  // the domain in 2D, its floor in 3D
  }

  /** A point of the plane. */
  at(across, along) {
    return this.dim == 2 ? [across, along, 0] : [across, 0, along];
  }

  /** The domain and its grid, which is `opacity` visible, with the numbers of its cells if asked. */
  drawUnder(pen, camera, opacity, isNumbered) {
    const [across, along] = this.plane.map(axis => this.size[axis]);
    const colors = this.theme.css;
    pen.fillStyle = colors.panel;
    this.trace(pen, camera, [[0, 0], [across, 0], [across, along], [0, along], [0, 0]]
      .map(at => this.at(...at)));
    pen.fill();
    pen.strokeStyle = colors.line;
    pen.lineWidth = 1;
    pen.globalAlpha = opacity;
    if (opacity > 0) {
      pen.beginPath();
      this.plane.forEach((axis, which) => {
        const every = ROUND.find(k => k * this.pixels(camera, axis) >= FINEST) ?? Infinity;
        for (let i = every; i < this.cells[axis]; i += every) {
          const at = i * this.size[axis] / this.cells[axis];
          const ends = which == 0 ? [[at, 0], [at, along]] : [[0, at], [across, at]];
          this.line(pen, camera, ...ends.map(end => this.at(...end)));
        }
      });
      pen.stroke();
      if (isNumbered) this.drawNumbers(pen, camera);
    }
    pen.globalAlpha = 1;
    this.drawEdges(pen, camera, false);
  }

  /** The front edges of a 3D domain, and the scale bar. */
  drawOver(pen, camera) {
    if (this.dim == 3) {
      pen.globalAlpha = 0.6;
      this.drawEdges(pen, camera, true);
      pen.globalAlpha = 1;
    }
    this.drawScaleBar(pen, camera);
  }

  /** Width of a cell in the middle of the picture. */
  pixels(camera, axis) {
    return camera.scale * this.size[axis] / this.cells[axis];
  }

  /** Edges of the domain, those at the corner next to the viewer or the others.  In 2D a wall is a
   *  thick line, an open side a thin one, and a periodic side dashed. */
  drawEdges(pen, camera, front) {
    const corners = camera.corners(), toward = corners.map(corner => camera.look(corner)[3]);
    const nearest = toward.indexOf(Math.max(...toward));
    pen.strokeStyle = this.theme.css.line;
    pen.lineWidth = 1;
    for (let b = 0; b < corners.length; b++)
      for (let a = 0; a < b; a++) {
        const axis = Math.log2(a ^ b);
        if (!Number.isInteger(axis)) continue;
        if (this.dim == 2) this.asWall(pen, 1 - axis, b >> (1 - axis) & 1);
        else if (front != (a == nearest || b == nearest)) continue;
        pen.beginPath();
        this.line(pen, camera, corners[a], corners[b]);
        pen.stroke();
      }
    pen.setLineDash([]);
  }

  asWall(pen, axis, upper) {
    const rule = this.walls[axis][upper], isWall = rule != "none" && rule != "periodic";
    pen.lineWidth = isWall ? 3 : 1;
    pen.strokeStyle = isWall ? this.theme.css.wall : this.theme.css.line;
    pen.setLineDash(rule == "periodic" ? [6, 5] : []);
  }

  /** Numbers of the cells, from 0: in each cell where there is room, else along two sides. */
  drawNumbers(pen, camera) {
    const smallest = Math.min(...this.plane.map(axis => this.pixels(camera, axis)));
    pen.fillStyle = this.theme.css.faintInk;
    pen.font = `${SMALL}px system-ui, sans-serif`;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.globalAlpha = Math.min(1, 0.35 + pen.globalAlpha);
    if (this.dim == 2 && smallest >= ROOMY) this.numberCells(pen, camera);
    else this.plane.forEach((axis, which) => this.numberSide(pen, camera, axis, which));
  }

  numberCells(pen, camera) {
    const [dx, dy] = this.size.map((length, axis) => length / this.cells[axis]);
    const { scale, column, row, view: { center: [x, y] } } = camera;
    const seen = (low, high, axis) => [  // cells from ... to ...
      Math.max(Math.floor(low), 0), Math.min(Math.ceil(high), this.cells[axis]),
    ];
    const [left, right] = [x - column / scale, x + (camera.width - column) / scale];
    const [bottom, top] = [y - (camera.height - row) / scale, y + row / scale];
    const [i0, i1] = seen(left / dx, right / dx, 0), [j0, j1] = seen(bottom / dy, top / dy, 1);
    for (let j = j0; j < j1; j++)
      for (let i = i0; i < i1; i++) {
        const [at, height] = camera.look([(i + 0.5) * dx, (j + 0.5) * dy, 0]);
        pen.fillText(`${i}, ${j}`, at, height);
      }
  }

  /** In 2D below and to the left, as far as the stage goes; in 3D beside the nearer edges. */
  numberSide(pen, camera, axis, which) {
    const other = this.plane[1 - which], width = this.size[axis] / this.cells[axis];
    const place = (at, beside) =>
      camera.look(which == 0 ? this.at(at, beside) : this.at(beside, at));
    let beside = 0;
    if (this.dim == 3) {
      const far = this.size[other], away = 1.3 * SMALL / camera.scale;
      beside = place(0, far)[3] > place(0, 0)[3] ? far + away : -away;
    }
    const [a, b] = [place(0, beside), place(this.size[axis], beside)];
    const pixels = Math.hypot(a[0] - b[0], a[1] - b[1]) / this.cells[axis];
    const every = ROUND.find(k => k * pixels >= 3 * SMALL) ?? Infinity;
    pen.textAlign = this.dim == 2 && which == 1 ? "right" : "center";
    for (let i = 0; i < this.cells[axis]; i += every) {
      let [column, row, seen] = place((i + 0.5) * width, beside);
      if (isNaN(seen)) continue;
      if (this.dim == 2 && which == 0) row = Math.min(row + SMALL, camera.height - SMALL);
      if (this.dim == 2 && which == 1) column = column > 20 ? column - 5 : 24;
      pen.fillText(i, column, row);
    }
  }
  /** A round length, as it is seen in the middle of the domain. */
  drawScaleBar(pen, camera) {
    const length = roundLength(90 / camera.scale), left = MARGIN.left, row = camera.height - 34;
    const pixels = length * camera.scale, words = withUnit(length, "m");
    pen.font = "13px system-ui, sans-serif";
    pen.fillStyle = this.theme.css.background;
    pen.globalAlpha = 0.75;
    pen.fillRect(left - 8, row - 8, Math.max(pixels, pen.measureText(words).width) + 16, 36);
    pen.globalAlpha = 1;
    pen.strokeStyle = pen.fillStyle = this.theme.css.ink;
    pen.lineWidth = 2;
    pen.beginPath();
    pen.moveTo(left, row);
    pen.lineTo(left + pixels, row);
    pen.stroke();
    pen.textAlign = "left";
    pen.textBaseline = "middle";
    pen.fillText(words, left, row + 16);
  }

  /** A ring about a particle. */
  drawRing(pen, camera, x, radius) {
    const [column, row, scale] = camera.look(x);
    if (isNaN(scale)) return;
    for (const [width, color] of [[5, this.theme.css.background], [2, this.theme.css.ink]]) {
      pen.lineWidth = width;
      pen.strokeStyle = color;
      pen.beginPath();
      pen.arc(column, row, Math.max(radius * scale + 4, 7), 0, 2 * Math.PI);
      pen.stroke();
    }
  }

  trace(pen, camera, points) {
    pen.beginPath();
    for (const point of points) pen.lineTo(...camera.look(point).slice(0, 2));
  }

  line(pen, camera, start, end) {
    const [a, b] = [camera.look(start), camera.look(end)];
    if (isNaN(a[2]) || isNaN(b[2])) return;
    pen.moveTo(a[0], a[1]);
    pen.lineTo(b[0], b[1]);
  }
}
