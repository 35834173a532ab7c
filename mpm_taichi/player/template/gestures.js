// Pointer, wheel and fingers on the stage.  One finger or the mouse pans in 2D and orbits in 3D;
// two fingers pan and zoom; in 3D the mouse pans with shift or another button than the first.

const CLICK = 5;  // pixels that a pointer may move in a click

class Gestures {
  constructor(stage, page) {
    Object.assign(this, { stage, page, camera: page.camera, pointers: new Map(), travel: 0 });
    const on = (kind, act) => stage.addEventListener(kind, act.bind(this), { passive: false });
    on("pointerdown", this.press);
    on("pointermove", this.drag);
    on("pointerup", this.release);
    on("pointercancel", this.release);
    on("wheel", this.turnWheel);
    on("dblclick", () => page.showAll());
    on("contextmenu", event => event.preventDefault());
  }

  place(event) {
    const { left, top } = this.stage.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  }

  press(event) {
    this.stage.setPointerCapture(event.pointerId);
    if (this.pointers.size == 0) this.travel = 0;
    this.pointers.set(event.pointerId, this.place(event));
    if (this.pointers.size > 1) this.travel = Infinity;
  }

  drag(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = this.place(event), [columns, rows] = [now[0] - before[0], now[1] - before[1]];
    const other = [...this.pointers].find(([id]) => id != event.pointerId)?.[1];
    this.pointers.set(event.pointerId, now);
    this.travel += Math.hypot(columns, rows);
    if (this.travel < CLICK) return;
    if (other) {
      const gap = at => Math.max(Math.hypot(at[0] - other[0], at[1] - other[1]), 1);
      this.camera.pan(columns / 2, rows / 2);
      this.camera.zoomBy(gap(now) / gap(before), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
    } else if (this.camera.dim == 3 && !event.shiftKey && event.buttons < 2) {
      this.camera.orbit(columns, rows);
    } else {
      this.camera.pan(columns, rows);
    }
    this.page.draw();
  }

  release(event) {
    const was = this.pointers.delete(event.pointerId);
    if (was && event.type == "pointerup" && this.travel < CLICK)
      this.page.pickAt(...this.place(event));
  }

  turnWheel(event) {
    event.preventDefault();
    const lines = event.deltaY * [1, 16, 400][event.deltaMode];
    this.camera.zoomBy(Math.exp(-Math.min(Math.max(lines, -200), 200) / 400), ...this.place(event));
    this.page.draw();
  }
}
