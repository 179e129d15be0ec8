// SPDX-License-Identifier: Apache-2.0
// Tells what a mouse or fingers do in a picture: clicks, drags, pinches, and turns of the wheel.

export interface PointerHandlers {
  click(x: number, y: number, event: PointerEvent): void; // position in the picture, from 0 to 1
  // A drag by dx, dy since its begin, as shares of the picture's width; dy is positive downwards.
  drag(dx: number, dy: number, begin: PointerEvent): void;
  pinch(factor: number): void; // factor by which two fingers have moved apart since their begin
  begin(): void; // is called before the first drag() or pinch()
  end(): void; // is called after the last one
  cancel(): void; // instead of end(): the change is to be forgotten
  wheel(turn: number, event: WheelEvent): void; // positive: towards the person; about 1 for a notch
}

const LEAST_DRAG_PX = 4; // shorter movements are clicks

export class PicturePointer {
  private readonly fingers = new Map<number, PointerEvent>();
  private first: PointerEvent | null = null; // where the drag began; null: none is going on
  private spread = 0; // distance of two fingers when the pinch began; 0: no pinch
  private hasMoved = false;

  constructor(
    private readonly box: HTMLElement,
    private readonly handlers: PointerHandlers,
  ) {
    box.style.touchAction = "none";
    box.addEventListener("pointerdown", (event) => this.down(event));
    box.addEventListener("pointermove", (event) => this.move(event));
    box.addEventListener("pointerup", (event) => this.up(event));
    box.addEventListener("pointercancel", () => this.cancel());
    box.addEventListener("contextmenu", (event) => event.preventDefault());
    box.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? event.deltaY / 3 : event.deltaY / 100;
        // A pinch on a touchpad is sent as small turns of the wheel with Ctrl.
        handlers.wheel(event.ctrlKey ? 8 * lines : Math.max(-3, Math.min(3, lines)), event);
      },
      { passive: false },
    );
    window.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && this.hasMoved) this.cancel();
    });
  }

  private down(event: PointerEvent): void {
    this.box.setPointerCapture(event.pointerId);
    this.fingers.set(event.pointerId, event);
    if (this.fingers.size === 1) {
      this.first = event;
    } else if (this.fingers.size === 2) {
      // The second finger turns a drag into a pinch.
      if (this.hasMoved) this.handlers.end();
      this.hasMoved = false;
      this.first = null;
      this.spread = this.distance();
    }
  }

  private distance(): number {
    const [a, b] = [...this.fingers.values()];
    return Math.max(1, Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY));
  }

  private move(event: PointerEvent): void {
    if (!this.fingers.has(event.pointerId)) return;
    this.fingers.set(event.pointerId, event);
    const { first } = this;
    if (this.spread > 0 && this.fingers.size === 2) {
      this.start();
      this.handlers.pinch(this.distance() / this.spread);
    } else if (first) {
      const [dx, dy] = [event.clientX - first.clientX, event.clientY - first.clientY];
      if (!this.hasMoved && Math.hypot(dx, dy) < LEAST_DRAG_PX) return;
      this.start();
      const { width } = this.box.getBoundingClientRect();
      this.handlers.drag(dx / width, dy / width, first);
    }
  }

  private start(): void {
    if (!this.hasMoved) this.handlers.begin();
    this.hasMoved = true;
  }

  private up(event: PointerEvent): void {
    if (!this.fingers.delete(event.pointerId)) return;
    const { first, hasMoved } = this;
    this.forget();
    if (hasMoved) return this.handlers.end();
    if (!first || event.button !== 0) return;
    const box = this.box.getBoundingClientRect();
    this.handlers.click((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height, event);
  }

  private cancel(): void {
    const { hasMoved } = this;
    this.fingers.clear();
    this.forget();
    if (hasMoved) this.handlers.cancel();
  }

  // Ends the drag or pinch. A finger that is still there does not begin another one.
  private forget(): void {
    this.first = null;
    this.spread = 0;
    this.hasMoved = false;
  }
}
