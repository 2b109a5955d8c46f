// Converts mouse, touch and pen input on the stage to gestures. Positions are window pixels of the
// camera (CSS pixels × scale), not of the page. This file does not depend on tools. The listener
// decides on the effect of a drag with the tool button.
//
// A hand that holds a pen rests on the screen. While a pen touches the screen or is in range, and
// for a moment afterwards, all touches are treated as this hand. Current touches are canceled, and
// new touches are ignored until they are lifted. After the first use of a pen, only the pen paints,
// and fingers rotate.

export interface PointerSample {
  x: number;
  y: number;
  /** The pressure of a pen, 0…1. */
  pressure?: number;
  /** Whether these keys are held while the button is pressed. */
  shift?: boolean;
  alt?: boolean;
}

export interface GestureHandler {
  /** A drag of the tool, with the left button, a pen or one finger. */
  toolDown(sample: PointerSample): void;
  toolMove(samples: PointerSample[]): void;
  toolUp(): void;
  /**
   * A second finger touched, or the system canceled the pointer. The previous effect of the tool is
   * kept.
   */
  toolCancel(): void;
  orbit(dx: number, dy: number): void;
  pan(dx: number, dy: number): void;
  /** A factor less than 1 zooms in. The point at (x, y) keeps its position. */
  zoom(factor: number, x: number, y: number): void;
  /** A rotation by two fingers, in radians clockwise on the screen. */
  twist(angle: number): void;
  hover(sample: PointerSample | null): void;
  /**
   * A mouse moves without a pressed button. Null means that the mouse has left, or that another
   * pointer is used.
   */
  freeMouse(sample: PointerSample | null): void;
  /** Whether only a pen can use the tool. If so, one finger rotates the model. */
  toolIsForPen(): boolean;
}

type Drag = "tool" | "orbit" | "pan";

// A finger starts the tool after this movement or time, so two fingers that touch at the same time
// do not paint. A later second finger ends the stroke, which is kept and can be undone.
const kTouchSlop = 6; // CSS pixels
const kTouchDelayMs = 140;
const kPenLingerMs = 400; // between two strokes, only the pen is lifted
// A pen in range sends events continuously. After this time without events, the pen has left.
const kPenSilenceMs = 3000;
const kWheelStep = 0.0016; // zoom per scrolled pixel

export class StageInput {
  /** While Space is pressed, the tool button rotates the model. */
  orbitHeld = false;

  private readonly _pointers = new Map<number, PointerSample>(); // in CSS pixels of the element
  private _drag: { kind: Drag; pointer: number; last: PointerSample } | null = null;
  private _waitingTouch: {
    pointer: number;
    start: PointerSample;
    timer: ReturnType<typeof setTimeout>;
  } | null = null;
  private _pinch: { distance: number; angle: number; middle: PointerSample } | null = null;
  private _penNear = false; // in range now or recently
  private _penTimer: ReturnType<typeof setTimeout> | null = null;
  private _penUsed = false;
  private readonly _fingers = new Set<number>(); // a subset of _pointers
  // Touches that are ignored until they are lifted.
  private readonly _palms = new Set<number>();
  private readonly _listeners: [string, (event: never) => void, AddEventListenerOptions?][] = [];

  constructor(
    private readonly _element: HTMLElement,
    private readonly _handler: GestureHandler,
    /** The number of window pixels per CSS pixel. */
    private readonly _scale: () => number,
  ) {
    this.listen("pointerdown", (event: PointerEvent) => this.onDown(event));
    this.listen("pointermove", (event: PointerEvent) => this.onMove(event));
    this.listen("pointerup", (event: PointerEvent) => this.onUp(event, false));
    this.listen("pointercancel", (event: PointerEvent) => this.onUp(event, true));
    this.listen("pointerleave", (event: PointerEvent) => {
      if (event.pointerType !== "touch" && !this._drag) this._handler.hover(null);
      this._handler.freeMouse(null);
      if (event.pointerType === "pen") this.penIsNear(kPenLingerMs);
    });
    this.listen("wheel", (event: WheelEvent) => this.onWheel(event), { passive: false });
    this.listen("contextmenu", (event: Event) => event.preventDefault());
    this.listen("dragstart", (event: Event) => event.preventDefault());
  }

  detach(): void {
    for (const [name, listener] of this._listeners)
      this._element.removeEventListener(name, listener as EventListener);
    this.forgetWaitingTouch();
    if (this._penTimer) clearTimeout(this._penTimer);
  }

  /**
   * Marks the pen as near for `forMs` after its last event, or without a time limit if `forMs` is
   * null.
   */
  private penIsNear(forMs: number | null): void {
    if (this._penTimer) clearTimeout(this._penTimer);
    this._penTimer = forMs === null ? null : setTimeout(() => (this._penNear = false), forMs);
    if (this._penNear) return;
    this._penNear = true;
    this.dropFingers();
  }

  /**
   * Ignores the current touches from now on, because they belong to the hand with the pen. Their
   * previous effect is kept.
   */
  private dropFingers(): void {
    if (this._fingers.size === 0) return;
    this.forgetWaitingTouch();
    if (this._drag && this._fingers.has(this._drag.pointer)) {
      if (this._drag.kind === "tool") this._handler.toolCancel();
      this._drag = null;
    }
    this._pinch = null;
    for (const finger of this._fingers) {
      this._pointers.delete(finger);
      this._palms.add(finger);
    }
    this._fingers.clear();
    this._handler.hover(null);
  }

  private listen<E extends Event>(
    name: string,
    listener: (event: E) => void,
    options?: AddEventListenerOptions,
  ): void {
    this._element.addEventListener(name, listener as EventListener, options);
    this._listeners.push([name, listener, options]);
  }

  private cssPosition(event: { clientX: number; clientY: number }): PointerSample {
    const box = this._element.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  private toWindow(css: PointerSample): PointerSample {
    const scale = this._scale();
    return { x: css.x * scale, y: css.y * scale };
  }

  /** Returns the position, the held keys and, for a pen, the pressure. */
  private pressed(event: PointerEvent): PointerSample {
    return {
      ...this.toWindow(this.cssPosition(event)),
      ...(event.pointerType === "pen" ? { pressure: event.pressure } : {}),
      ...(event.shiftKey ? { shift: true } : {}),
      ...(event.altKey ? { alt: true } : {}),
    };
  }

  private onDown(event: PointerEvent): void {
    if (event.pointerType === "pen") {
      this._penUsed = true;
      this.penIsNear(null);
    }
    if (event.pointerType === "touch" && this._penNear) {
      this._palms.add(event.pointerId);
      return;
    }
    const at = this.cssPosition(event);
    this._element.setPointerCapture(event.pointerId);
    this._pointers.set(event.pointerId, at);
    this._handler.freeMouse(null);
    if (event.pointerType === "touch") {
      this._fingers.add(event.pointerId);
      this.onTouchDown(event.pointerId, at);
      return;
    }
    if (this._drag) return;
    event.preventDefault();
    this._element.focus({ preventScroll: true });
    const kind = dragOf(event, this.orbitHeld);
    if (!kind) return;
    this._drag = { kind, pointer: event.pointerId, last: at };
    if (kind === "tool") this._handler.toolDown(this.pressed(event));
  }

  private onTouchDown(pointer: number, at: PointerSample): void {
    if (this._pointers.size === 1) {
      const timer = setTimeout(() => this.startTouchTool(), kTouchDelayMs);
      this._waitingTouch = { pointer, start: at, timer };
      return;
    }
    this.forgetWaitingTouch();
    if (this._drag?.kind === "tool") this._handler.toolCancel();
    this._drag = null;
    this._pinch = this.pinchNow();
    this._handler.hover(null);
  }

  private startTouchTool(): void {
    const waiting = this._waitingTouch;
    if (!waiting) return;
    this.forgetWaitingTouch();
    const kind = this._penUsed && this._handler.toolIsForPen() ? "orbit" : "tool";
    this._drag = { kind, pointer: waiting.pointer, last: waiting.start };
    if (kind === "tool") this._handler.toolDown(this.toWindow(waiting.start));
  }

  private forgetWaitingTouch(): void {
    if (this._waitingTouch) clearTimeout(this._waitingTouch.timer);
    this._waitingTouch = null;
  }

  private onMove(event: PointerEvent): void {
    if (this._palms.has(event.pointerId)) return;
    if (event.pointerType === "pen")
      this.penIsNear(this._pointers.has(event.pointerId) ? null : kPenSilenceMs);
    const at = this.cssPosition(event);
    if (this._pointers.has(event.pointerId)) this._pointers.set(event.pointerId, at);
    if (this._pinch) {
      this.onPinch();
      return;
    }
    if (event.pointerType !== "touch") this._handler.hover(this.toWindow(at));
    this._handler.freeMouse(
      event.pointerType === "mouse" && event.buttons === 0 ? this.toWindow(at) : null,
    );
    const waiting = this._waitingTouch;
    if (waiting?.pointer === event.pointerId) {
      if (Math.hypot(at.x - waiting.start.x, at.y - waiting.start.y) < kTouchSlop) return;
      this.startTouchTool();
    }
    const drag = this._drag;
    if (drag?.pointer !== event.pointerId) return;
    const scale = this._scale();
    const [dx, dy] = [(at.x - drag.last.x) * scale, (at.y - drag.last.y) * scale];
    drag.last = at;
    if (drag.kind === "orbit") this._handler.orbit(dx, dy);
    else if (drag.kind === "pan") this._handler.pan(dx, dy);
    else {
      const events = event.getCoalescedEvents?.() ?? [];
      const samples = (events.length > 0 ? events : [event]).map((each) => this.pressed(each));
      if (event.pointerType === "touch") this._handler.hover(this.toWindow(at));
      this._handler.toolMove(samples);
    }
  }

  private onUp(event: PointerEvent, cancelled: boolean): void {
    if (this._palms.delete(event.pointerId)) return;
    if (event.pointerType === "pen") this.penIsNear(kPenSilenceMs);
    this._fingers.delete(event.pointerId);
    if (!this._pointers.delete(event.pointerId)) return;
    if (this._pinch) {
      this._pinch = this._pointers.size >= 2 ? this.pinchNow() : null;
      return;
    }
    if (this._waitingTouch?.pointer === event.pointerId) {
      if (cancelled) this.forgetWaitingTouch();
      else this.startTouchTool(); // a tap paints one dab
    }
    if (this._drag?.pointer !== event.pointerId) return;
    const { kind } = this._drag;
    this._drag = null;
    if (kind === "tool") {
      if (cancelled) this._handler.toolCancel();
      else this._handler.toolUp();
    }
    if (event.pointerType === "touch") this._handler.hover(null);
  }

  private pinchNow(): { distance: number; angle: number; middle: PointerSample } | null {
    const [a, b] = [...this._pointers.values()];
    if (!a || !b) return null;
    return {
      distance: Math.max(1, Math.hypot(b.x - a.x, b.y - a.y)),
      angle: Math.atan2(b.y - a.y, b.x - a.x),
      middle: { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 },
    };
  }

  private onPinch(): void {
    const before = this._pinch;
    const now = this.pinchNow();
    if (!before || !now) return;
    this._pinch = now;
    const scale = this._scale();
    this._handler.pan(
      (now.middle.x - before.middle.x) * scale,
      (now.middle.y - before.middle.y) * scale,
    );
    this._handler.zoom(before.distance / now.distance, now.middle.x * scale, now.middle.y * scale);
    const turn = now.angle - before.angle;
    this._handler.twist(Math.atan2(Math.sin(turn), Math.cos(turn)));
  }

  private onWheel(event: WheelEvent): void {
    event.preventDefault();
    const at = this.toWindow(this.cssPosition(event));
    const pixels = event.deltaY * (event.deltaMode === 1 ? 33 : event.deltaMode === 2 ? 400 : 1);
    const pinchBoost = event.ctrlKey ? 6 : 1; // a touchpad pinch sends small wheel steps with Ctrl
    const step = Math.max(-240, Math.min(240, pixels * pinchBoost));
    this._handler.zoom(Math.exp(step * kWheelStep), at.x, at.y);
  }
}

function dragOf(event: PointerEvent, orbitHeld: boolean): Drag | null {
  if (event.button === 0) return orbitHeld ? "orbit" : "tool";
  if (event.button === 1) return "pan";
  if (event.button === 2) return event.shiftKey ? "pan" : "orbit";
  return null;
}
