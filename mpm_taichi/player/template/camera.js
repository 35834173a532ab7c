// Where a point of the domain lies on the stage: the camera of mpm_taichi/renderers/camera.py,
// which the user may move.  Pixels are CSS pixels of the stage, from its upper left corner.

const TURN = 32 * Math.PI / 180, TILT = 20 * Math.PI / 180, DISTANCE = 4;
const MARGIN = { left: 30, right: 30, top: 20, bottom: 84 };
const MOST_ZOOM = 400, LEAST_ZOOM = 0.2;
const NEAREST = 0.9;  // part of the way from the center to the camera, beyond which nothing is seen

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

class Camera {
  constructor(size) {
    this.dim = size.length;
    this.size = [...size, 0].slice(0, 3);
    this.distance = this.dim == 2 ? Infinity : DISTANCE * Math.hypot(...this.size) / 2;
    this.reset();
  }

  /** The view at the start. */
  reset() {
    const [turn, tilt] = this.dim == 2 ? [0, 0] : [TURN, TILT];
    const center = this.size.map(length => length / 2);  // in the middle of the picture
    this.view = { turn, tilt, center, zoom: 1 };
  }

  /** Takes the size of the stage, and the scale at which the domain in the view at the start fills
   *  it up to the margins. */
  fit(width, height) {
    [this.width, this.height] = [width, height];
    const view = this.view;
    this.reset();
    [this.fitting, this.column, this.row] = [1, 0, 0];
    const seen = this.corners().map(corner => this.look(corner));
    const columns = seen.map(at => at[0]), rows = seen.map(at => at[1]);
    const [left, right] = [Math.min(...columns), Math.max(...columns)];
    const [top, bottom] = [Math.min(...rows), Math.max(...rows)];
    const across = width - MARGIN.left - MARGIN.right, down = height - MARGIN.top - MARGIN.bottom;
    const scale = Math.max(Math.min(across / (right - left), down / (bottom - top)), 1e-9);
    this.fitting = scale;
    this.column = MARGIN.left + across / 2 - scale * (left + right) / 2;
    this.row = MARGIN.top + down / 2 - scale * (top + bottom) / 2;
    this.view = view;
  }

  /** Pixels per m in the middle. */
  get scale() { return this.fitting * this.view.zoom; }

  corners() {
    return Array.from({ length: 2 ** this.dim }, (_, bits) =>
      this.size.map((length, axis) => bits >> axis & 1 ? length : 0));
  }

  /** The directions to the right, up and toward the viewer. */
  get axes() {
    const [s, c] = [Math.sin(this.view.turn), Math.cos(this.view.turn)];
    const [t, d] = [Math.sin(this.view.tilt), Math.cos(this.view.tilt)];
    return [[c, 0, -s], [-s * t, d, -c * t], [s * d, t, c * d]];
  }

  /** Column, row, pixels per m there, and how far toward the viewer [m] a point is; the scale is
   *  NaN behind the camera. */
  look(x) {
    const { center } = this.view;
    const r = [x[0] - center[0], x[1] - center[1], x[2] - center[2]];
    const [right, up, toward] = this.axes.map(axis => dot(axis, r));
    const nearness = toward / this.distance;
    const scale = nearness < NEAREST ? this.scale / (1 - nearness) : NaN;
    return [this.column + right * scale, this.row - up * scale, scale, toward];
  }

  pan(columns, rows) {
    const [right, up] = this.axes, scale = this.scale;
    this.view.center = this.view.center.map((at, axis) =>
      at - (right[axis] * columns - up[axis] * rows) / scale);
  }

  /** Dragged so many pixels, 180 for a radian. */
  orbit(columns, rows) {
    this.view.turn -= columns / 180;
    this.view.tilt = Math.min(Math.max(this.view.tilt + rows / 180, -Math.PI / 2), Math.PI / 2);
  }

  /** What is seen at a pixel, in 3D at the distance of the center, stays there. */
  zoomBy(factor, column = this.column, row = this.row) {
    const zoom = Math.min(Math.max(this.view.zoom * factor, LEAST_ZOOM), MOST_ZOOM);
    const away = this.view.zoom / zoom - 1;
    this.pan((column - this.column) * away, (row - this.row) * away);
    this.view.zoom = zoom;
  }
}
