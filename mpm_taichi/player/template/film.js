// The recorded frames: whole numbers as they were packed, and what they mean in SI units.

const GONE = 65535;  // all coordinates of a particle that was deleted
const RESTING = 127;  // a velocity component of 0

class Film {
  constructor(header) {
    Object.assign(this, header);
    const n = this.particles, dim = this.dimension, values = this.times.length * n;
    const make = (Kind, count) => Array.from({ length: count }, () => new Kind(values));
    this.coordinates = make(Uint16Array, dim);
    this.velocities = make(Uint8Array, dim);
    this.packed = this.quantities.filter(quantity => "step" in quantity);
    for (const quantity of this.packed) quantity.channel = new Uint8Array(values);
    this.stages = this.walk && new Stages(this);
    this.channels = [
      ...this.coordinates, ...this.velocities, ...this.packed.map(quantity => quantity.channel),
      ...(this.stages?.all ?? []),
    ];
    this.loaded = 0;  // frames that are there
    this.crc = 0;
  }

  /** Mass [kg], radius [m] and body of each particle. */
  async loadParticles() {
    const bytes = await inflated("data-particles"), n = this.particles;
    this.mass = new Float32Array(bytes.buffer, 0, n);
    this.radius = new Float32Array(bytes.buffer, 4 * n, n);
    this.body = new Uint16Array(bytes.buffer, 8 * n, n);
  }

  /** The next block of frames; their check sum goes on. */
  async loadBlock(number) {
    const bytes = await inflated(`data-block-${number}`), n = this.particles;
    const perFrame = this.channels.reduce((sum, channel) => sum + channel.BYTES_PER_ELEMENT * n, 0);
    const start = this.loaded, end = start + (bytes.length - this.channels.length) / perFrame;
    let at = 0;
    for (const channel of this.channels) at = unpackChannel(bytes, at, channel, n, start, end);
    for (let k = start; k < end; k++)
      for (const channel of this.channels) {
        const part = channel.subarray(k * n, k * n + n);
        this.crc = crc32(new Uint8Array(part.buffer, part.byteOffset, part.byteLength), this.crc);
      }
    this.loaded = end;
  }

  /** The next block of the nodes of stages, after all frames. */
  async loadNodes(number) {
    const bytes = await inflated(`data-nodes-${number}`);
    this.crc = crc32(bytes, this.crc);
    this.stages.read(bytes);
  }

  get checksum() { return this.crc.toString(16).padStart(8, "0"); }

  /** The last frame that is not after a time. */
  frameAt(time) {
    let low = 0, high = this.times.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.times[middle] <= time) low = middle; else high = middle - 1;
    }
    return low;
  }

  isGone(k, p) { return this.coordinates[0][k * this.particles + p] == GONE; }

  /** Positions and radii of a frame into an array [n, 4], in m; z is 0 in 2D, and the radius of a
   *  deleted particle. */
  places(k, out) {
    const n = this.particles;
    this.coordinates.forEach((channel, axis) => {
      const low = this.low[axis], step = this.step[axis];
      for (let p = 0, q = k * n; p < n; p++, q++) out[4 * p + axis] = low + step * channel[q];
    });
    for (let p = 0; p < n; p++) out[4 * p + 3] = this.isGone(k, p) ? 0 : this.radius[p];
    return out;
  }

  position(k, p) {
    const at = k * this.particles + p;
    return this.coordinates.map((channel, axis) => this.low[axis] + this.step[axis] * channel[at]);
  }

  velocity(k, p) {
    const at = k * this.particles + p;
    return this.velocities.map(channel => (channel[at] - RESTING) * this.velocityStep);
  }

  /** Values of a quantity, but not of "body", at all particles of a frame. */
  values(quantity, k, out) {
    const n = this.particles, at = k * n;
    if (quantity.channel) {
      const { low, step, channel } = quantity;
      for (let p = 0; p < n; p++) out[p] = low + step * channel[at + p];
      return out;
    }
    out.fill(0);
    for (const channel of this.velocities)
      for (let p = 0; p < n; p++) out[p] += (channel[at + p] - RESTING) ** 2;
    for (let p = 0; p < n; p++) out[p] = Math.sqrt(out[p]) * this.velocityStep;
    return out;
  }
}
