// The recorded stages of the step that follows each frame: mpm_taichi/player/stage_film.py.

const KINDS = { velocity: 2, gain: 2, stress: 3, gradient: 4 };  // channels of each

/** The number that 16 bits are in half precision. */
function fromHalf(bits) {
  const size = bits & 0x7fff, exponent = size >> 10;
  const value = exponent ? (1024 + (size & 1023)) * 2 ** (exponent - 25) : size * 2 ** -24;
  return bits & 0x8000 ? -value : value;
}

class Stages {
  constructor(film) {
    Object.assign(this, film.walk);  // lengths, scales, moving, stages, basis, inverseMoment
    this.particles = film.particles;
    this.channels = {};
    for (const [name, count] of Object.entries(KINDS))
      this.channels[name] = Array.from(
        { length: count }, () => new Uint16Array(film.times.length * film.particles));
    this.frames = [];  // of the nodes
  }

  /** In the order of the film. */
  get all() { return Object.values(this.channels).flat(); }

  /** The frames of a block of nodes. */
  read({ buffer, byteLength }) {
    for (let at = 0; at < byteLength;) {
      const [count] = new Uint32Array(buffer, at, 1);
      const place = new Int16Array(buffer, at + 4, 2 * count);
      const floats = new Float32Array(buffer, at + 4 + 4 * count, (1 + 2 * this.moving.length) * count);
      this.frames.push(new Nodes(place, floats, this.moving));
      at += 4 + 4 * count + 4 * floats.length;
    }
  }

  /** Of particle p in frame k, by the name of a kind, in SI units. */
  of(name, k, p) {
    const at = k * this.particles + p;
    return this.channels[name].map(channel => fromHalf(channel[at]) * this.scales[name]);
  }
}

/** The nodes of a frame. */
class Nodes {
  constructor(place, floats, moving) {
    this.count = floats.length / (1 + 2 * moving.length);
    this.place = place;
    this.mass = floats.subarray(0, this.count);
    this.heaviest = this.mass.reduce((most, mass) => Math.max(most, mass), 0);
    this.velocities = Object.fromEntries(moving.map((name, number) => [
      name, floats.subarray((1 + 2 * number) * this.count, (3 + 2 * number) * this.count),
    ]));
  }

  /** The node at a place (x / dx), or undefined. */
  at(place) {
    this.byPlace ??= new Map(Array.from(this.mass, (_, i) => [this.key(this.placeOf(i)), i]));
    return this.byPlace.get(this.key(place));
  }

  key([i, j]) { return 65536 * i + j; }

  placeOf(i) { return [this.place[2 * i], this.place[2 * i + 1]]; }

  velocity(stage, i) {
    const values = this.velocities[stage];
    return [values[2 * i], values[2 * i + 1]];
  }
}
