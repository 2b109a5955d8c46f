// Mouse, touch and pen on the stage → gestures. Positions are window pixels of the camera (CSS
// pixels × scale), not of the page. Knows nothing of tools: who listens decides what a drag of the
// tool button means.
//
// A hand that holds a pen rests on the glass. While a pen touches or is in range, and for a moment
// afterwards, touches are that hand: those that were there are dropped, new ones are not listened
// to, and none of them counts before it was lifted. Once a pen has been used, fingers turn what the
// pen paints.

export interface PointerSample {
  x: number;
  y: number;
  /** Of a pen: 0…1. */
  pressure?: number;
}

export interface GestureHandler {
  /** The tool's drag: left button, pen, or one finger. */
  tool_down(sample: PointerSample): void;
  tool_move(samples: PointerSample[]): void;
  tool_up(): void;
  /** A second finger came, or the system took the pointer away. What the tool did so far stands. */
  tool_cancel(): void;
  orbit(dx: number, dy: number): void;
  pan(dx: number, dy: number): void;
  /** factor < 1 comes nearer; (x, y) stays in place. */
  zoom(factor: number, x: number, y: number): void;
  /** Two fingers turned against each other, radians clockwise on the screen. */
  twist(angle: number): void;
  hover(sample: PointerSample | null): void;
  /** A mouse is there with nothing pressed; null: no longer, or something else points. */
  free_mouse(sample: PointerSample | null): void;
  /** Where a pen is in use it alone has this tool, and one finger turns instead. */
  tool_is_for_pen(): boolean;
}

type Drag = "tool" | "orbit" | "pan";

// A finger's tool starts once it has moved or rested so much: two fingers that land together then
// paint no dab. A second one that comes later ends the stroke, which stays and can be undone.
const kTouchSlop = 6; // CSS pixels
const kTouchDelay_ms = 140;
const kPenLinger_ms = 400; // between two strokes a pen leaves, and the hand that holds it stays
// a pen in range tells of itself all the time; one that does not has gone without a word
const kPenSilence_ms = 3000;
const kWheelStep = 0.0016; // per pixel of scrolling

export class StageInput {
  /** Held space turns the tool button into orbit. */
  orbit_held = false;

  private readonly pointers_ = new Map<number, PointerSample>(); // CSS pixels within the element
  private drag_: { kind: Drag; pointer: number; last: PointerSample } | null = null;
  private waiting_touch_: {
    pointer: number;
    start: PointerSample;
    timer: ReturnType<typeof setTimeout>;
  } | null = null;
  private pinch_: { distance: number; angle: number; middle: PointerSample } | null = null;
  private pen_near_ = false; // or was just now
  private pen_timer_: ReturnType<typeof setTimeout> | null = null;
  private pen_used_ = false;
  private readonly fingers_ = new Set<number>(); // of pointers_
  // touches that are not listened to, until they are lifted
  private readonly palms_ = new Set<number>();
  private readonly listeners_: [string, (event: never) => void, AddEventListenerOptions?][] = [];

  constructor(
    private readonly element_: HTMLElement,
    private readonly handler_: GestureHandler,
    /** Window pixels per CSS pixel. */
    private readonly scale_: () => number,
  ) {
    this.listen("pointerdown", (event: PointerEvent) => this.on_down(event));
    this.listen("pointermove", (event: PointerEvent) => this.on_move(event));
    this.listen("pointerup", (event: PointerEvent) => this.on_up(event, false));
    this.listen("pointercancel", (event: PointerEvent) => this.on_up(event, true));
    this.listen("pointerleave", (event: PointerEvent) => {
      if (event.pointerType !== "touch" && !this.drag_) this.handler_.hover(null);
      this.handler_.free_mouse(null);
      if (event.pointerType === "pen") this.pen_is_near(kPenLinger_ms);
    });
    this.listen("wheel", (event: WheelEvent) => this.on_wheel(event), { passive: false });
    this.listen("contextmenu", (event: Event) => event.preventDefault());
    this.listen("dragstart", (event: Event) => event.preventDefault());
  }

  detach(): void {
    for (const [name, listener] of this.listeners_)
      this.element_.removeEventListener(name, listener as EventListener);
    this.forget_waiting_touch();
    if (this.pen_timer_) clearTimeout(this.pen_timer_);
  }

  /** `for_ms`: unless it is heard of again; null: until then. */
  private pen_is_near(for_ms: number | null): void {
    if (this.pen_timer_) clearTimeout(this.pen_timer_);
    this.pen_timer_ = for_ms === null ? null : setTimeout(() => (this.pen_near_ = false), for_ms);
    if (this.pen_near_) return;
    this.pen_near_ = true;
    this.drop_fingers();
  }

  /** They were the hand that brought the pen. What they did so far stands. */
  private drop_fingers(): void {
    if (this.fingers_.size === 0) return;
    this.forget_waiting_touch();
    if (this.drag_ && this.fingers_.has(this.drag_.pointer)) {
      if (this.drag_.kind === "tool") this.handler_.tool_cancel();
      this.drag_ = null;
    }
    this.pinch_ = null;
    for (const finger of this.fingers_) {
      this.pointers_.delete(finger);
      this.palms_.add(finger);
    }
    this.fingers_.clear();
    this.handler_.hover(null);
  }

  private listen<E extends Event>(
    name: string,
    listener: (event: E) => void,
    options?: AddEventListenerOptions,
  ): void {
    this.element_.addEventListener(name, listener as EventListener, options);
    this.listeners_.push([name, listener, options]);
  }

  private css_position(event: { clientX: number; clientY: number }): PointerSample {
    const box = this.element_.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  private to_window(css: PointerSample): PointerSample {
    const scale = this.scale_();
    return { x: css.x * scale, y: css.y * scale };
  }

  /** Where it is, and how strongly a pen is pressed on. */
  private pressed(event: PointerEvent): PointerSample {
    const at = this.to_window(this.css_position(event));
    return event.pointerType === "pen" ? { ...at, pressure: event.pressure } : at;
  }

  private on_down(event: PointerEvent): void {
    if (event.pointerType === "pen") {
      this.pen_used_ = true;
      this.pen_is_near(null);
    }
    if (event.pointerType === "touch" && this.pen_near_) {
      this.palms_.add(event.pointerId);
      return;
    }
    const at = this.css_position(event);
    this.element_.setPointerCapture(event.pointerId);
    this.pointers_.set(event.pointerId, at);
    this.handler_.free_mouse(null);
    if (event.pointerType === "touch") {
      this.fingers_.add(event.pointerId);
      this.on_touch_down(event.pointerId, at);
      return;
    }
    if (this.drag_) return;
    event.preventDefault();
    this.element_.focus({ preventScroll: true });
    const kind = drag_of(event, this.orbit_held);
    if (!kind) return;
    this.drag_ = { kind, pointer: event.pointerId, last: at };
    if (kind === "tool") this.handler_.tool_down(this.pressed(event));
  }

  private on_touch_down(pointer: number, at: PointerSample): void {
    if (this.pointers_.size === 1) {
      const timer = setTimeout(() => this.start_touch_tool(), kTouchDelay_ms);
      this.waiting_touch_ = { pointer, start: at, timer };
      return;
    }
    this.forget_waiting_touch();
    if (this.drag_?.kind === "tool") this.handler_.tool_cancel();
    this.drag_ = null;
    this.pinch_ = this.pinch_now();
    this.handler_.hover(null);
  }

  private start_touch_tool(): void {
    const waiting = this.waiting_touch_;
    if (!waiting) return;
    this.forget_waiting_touch();
    const kind = this.pen_used_ && this.handler_.tool_is_for_pen() ? "orbit" : "tool";
    this.drag_ = { kind, pointer: waiting.pointer, last: waiting.start };
    if (kind === "tool") this.handler_.tool_down(this.to_window(waiting.start));
  }

  private forget_waiting_touch(): void {
    if (this.waiting_touch_) clearTimeout(this.waiting_touch_.timer);
    this.waiting_touch_ = null;
  }

  private on_move(event: PointerEvent): void {
    if (this.palms_.has(event.pointerId)) return;
    if (event.pointerType === "pen")
      this.pen_is_near(this.pointers_.has(event.pointerId) ? null : kPenSilence_ms);
    const at = this.css_position(event);
    if (this.pointers_.has(event.pointerId)) this.pointers_.set(event.pointerId, at);
    if (this.pinch_) {
      this.on_pinch();
      return;
    }
    if (event.pointerType !== "touch") this.handler_.hover(this.to_window(at));
    this.handler_.free_mouse(
      event.pointerType === "mouse" && event.buttons === 0 ? this.to_window(at) : null,
    );
    const waiting = this.waiting_touch_;
    if (waiting?.pointer === event.pointerId) {
      if (Math.hypot(at.x - waiting.start.x, at.y - waiting.start.y) < kTouchSlop) return;
      this.start_touch_tool();
    }
    const drag = this.drag_;
    if (drag?.pointer !== event.pointerId) return;
    const scale = this.scale_();
    const [dx, dy] = [(at.x - drag.last.x) * scale, (at.y - drag.last.y) * scale];
    drag.last = at;
    if (drag.kind === "orbit") this.handler_.orbit(dx, dy);
    else if (drag.kind === "pan") this.handler_.pan(dx, dy);
    else {
      const events = event.getCoalescedEvents?.() ?? [];
      const samples = (events.length > 0 ? events : [event]).map((each) => this.pressed(each));
      if (event.pointerType === "touch") this.handler_.hover(this.to_window(at));
      this.handler_.tool_move(samples);
    }
  }

  private on_up(event: PointerEvent, cancelled: boolean): void {
    if (this.palms_.delete(event.pointerId)) return;
    if (event.pointerType === "pen") this.pen_is_near(kPenSilence_ms);
    this.fingers_.delete(event.pointerId);
    if (!this.pointers_.delete(event.pointerId)) return;
    if (this.pinch_) {
      this.pinch_ = this.pointers_.size >= 2 ? this.pinch_now() : null;
      return;
    }
    if (this.waiting_touch_?.pointer === event.pointerId) {
      if (cancelled) this.forget_waiting_touch();
      else this.start_touch_tool(); // a tap: the tool's dab
    }
    if (this.drag_?.pointer !== event.pointerId) return;
    const { kind } = this.drag_;
    this.drag_ = null;
    if (kind === "tool") {
      if (cancelled) this.handler_.tool_cancel();
      else this.handler_.tool_up();
    }
    if (event.pointerType === "touch") this.handler_.hover(null);
  }

  private pinch_now(): { distance: number; angle: number; middle: PointerSample } | null {
    const [a, b] = [...this.pointers_.values()];
    if (!a || !b) return null;
    return {
      distance: Math.max(1, Math.hypot(b.x - a.x, b.y - a.y)),
      angle: Math.atan2(b.y - a.y, b.x - a.x),
      middle: { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 },
    };
  }

  private on_pinch(): void {
    const before = this.pinch_;
    const now = this.pinch_now();
    if (!before || !now) return;
    this.pinch_ = now;
    const scale = this.scale_();
    this.handler_.pan(
      (now.middle.x - before.middle.x) * scale,
      (now.middle.y - before.middle.y) * scale,
    );
    this.handler_.zoom(before.distance / now.distance, now.middle.x * scale, now.middle.y * scale);
    const turn = now.angle - before.angle;
    this.handler_.twist(Math.atan2(Math.sin(turn), Math.cos(turn)));
  }

  private on_wheel(event: WheelEvent): void {
    event.preventDefault();
    const at = this.to_window(this.css_position(event));
    const pixels = event.deltaY * (event.deltaMode === 1 ? 33 : event.deltaMode === 2 ? 400 : 1);
    const pinch_boost = event.ctrlKey ? 6 : 1; // a touchpad's pinch comes as small ctrl-wheel steps
    const step = Math.max(-240, Math.min(240, pixels * pinch_boost));
    this.handler_.zoom(Math.exp(step * kWheelStep), at.x, at.y);
  }
}

function drag_of(event: PointerEvent, orbit_held: boolean): Drag | null {
  if (event.button === 0) return orbit_held ? "orbit" : "tool";
  if (event.button === 1) return "pan";
  if (event.button === 2) return event.shiftKey ? "pan" : "orbit";
  return null;
}
