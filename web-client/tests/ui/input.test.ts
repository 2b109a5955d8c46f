import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { StageInput, type GestureHandler } from "../../src/ui/input";

// A fake element that stores listeners and sends events to them.
class FakeElement {
  listeners = new Map<string, (event: unknown) => void>();
  addEventListener = (name: string, listener: (event: unknown) => void): void =>
    void this.listeners.set(name, listener);
  removeEventListener = (name: string): void => void this.listeners.delete(name);
  getBoundingClientRect = (): { left: number; top: number } => ({ left: 100, top: 50 });
  setPointerCapture = (): void => {};
  focus = (): void => {};
  fire(name: string, event: Record<string, unknown>): void {
    this.listeners.get(name)?.({ preventDefault: () => {}, ...event });
  }
}

let element: FakeElement;
let input: StageInput;
let handler: { [Name in keyof GestureHandler]: ReturnType<typeof vi.fn<GestureHandler[Name]>> };

const mouse = (button: number, x: number, y: number, more = {}): Record<string, unknown> => ({
  pointerId: 1,
  pointerType: "mouse",
  button,
  clientX: 100 + x,
  clientY: 50 + y,
  shiftKey: false,
  ...more,
});
const touch = (pointerId: number, x: number, y: number): Record<string, unknown> => ({
  pointerId,
  pointerType: "touch",
  button: 0,
  clientX: 100 + x,
  clientY: 50 + y,
});
const pen = (x: number, y: number, more = {}): Record<string, unknown> => ({
  pointerId: 90,
  pointerType: "pen",
  button: 0,
  buttons: 1,
  clientX: 100 + x,
  clientY: 50 + y,
  ...more,
});
const hovering = { button: -1, buttons: 0 };

beforeEach(() => {
  vi.useFakeTimers();
  element = new FakeElement();
  handler = {
    toolDown: vi.fn(),
    toolMove: vi.fn(),
    toolUp: vi.fn(),
    toolCancel: vi.fn(),
    orbit: vi.fn(),
    pan: vi.fn(),
    zoom: vi.fn(),
    twist: vi.fn(),
    hover: vi.fn(),
    freeMouse: vi.fn(),
    toolIsForPen: vi.fn(() => true),
  };
  input = new StageInput(element as unknown as HTMLElement, handler, () => 2);
});
afterEach(() => {
  input.detach();
  vi.useRealTimers();
});

describe("mouse", () => {
  it("left drags the tool, in window pixels of the stage", () => {
    element.fire("pointerdown", mouse(0, 10, 20));
    element.fire("pointermove", mouse(0, 11, 22));
    element.fire("pointerup", mouse(0, 11, 22));
    expect(handler.toolDown.mock.calls).toEqual([[{ x: 20, y: 40 }]]);
    expect(handler.toolMove.mock.calls).toEqual([[[{ x: 22, y: 44 }]]]);
    expect(handler.toolUp).toHaveBeenCalledTimes(1);
  });

  it("is free where nothing is pressed, until something is", () => {
    element.fire("pointermove", mouse(0, 10, 20, { buttons: 0 }));
    element.fire("pointerdown", mouse(2, 10, 20, { buttons: 2 }));
    element.fire("pointermove", mouse(2, 11, 22, { buttons: 2 }));
    element.fire("pointermove", { ...mouse(0, 12, 20, { buttons: 0 }), pointerType: "pen" });
    expect(handler.freeMouse.mock.calls).toEqual([[{ x: 20, y: 40 }], [null], [null], [null]]);
  });

  it("all the points between two pictures are kept", () => {
    element.fire("pointerdown", mouse(0, 0, 0));
    const between = [mouse(0, 1, 0), mouse(0, 2, 0), mouse(0, 3, 0)];
    element.fire("pointermove", mouse(0, 3, 0, { getCoalescedEvents: () => between }));
    expect(handler.toolMove.mock.calls[0]![0].map(({ x }) => x)).toEqual([2, 4, 6]);
  });

  it("right turns, middle and shift-right move, held space makes left turn", () => {
    const drag = (button: number, more = {}): void => {
      element.fire("pointerdown", mouse(button, 0, 0, more));
      element.fire("pointermove", mouse(button, 3, 1, more));
      element.fire("pointerup", mouse(button, 3, 1, more));
    };
    drag(2);
    drag(1);
    drag(2, { shiftKey: true });
    input.orbitHeld = true;
    drag(0);
    expect(handler.orbit.mock.calls).toEqual([
      [6, 2],
      [6, 2],
    ]);
    expect(handler.pan.mock.calls).toEqual([
      [6, 2],
      [6, 2],
    ]);
    expect(handler.toolDown).not.toHaveBeenCalled();
  });

  it("the wheel zooms where the pointer is: up comes nearer", () => {
    element.fire("wheel", { clientX: 130, clientY: 60, deltaY: -100, deltaMode: 0 });
    element.fire("wheel", { clientX: 130, clientY: 60, deltaY: 3, deltaMode: 1 });
    const [[nearer, x, y], [farther]] = handler.zoom.mock.calls as [
      [number, number, number],
      [number],
    ];
    expect(nearer).toBeLessThan(1);
    expect(farther).toBeGreaterThan(1);
    expect([x, y]).toEqual([60, 20]);
  });

  it("leaving the stage ends hovering", () => {
    element.fire("pointermove", mouse(0, 1, 1));
    element.fire("pointerleave", mouse(0, 1, 1));
    expect(handler.hover.mock.calls).toEqual([[{ x: 2, y: 2 }], [null]]);
  });
});

describe("touch", () => {
  it("one finger drags the tool once it has moved", () => {
    element.fire("pointerdown", touch(1, 10, 10));
    expect(handler.toolDown).not.toHaveBeenCalled();
    element.fire("pointermove", touch(1, 12, 10));
    expect(handler.toolDown).not.toHaveBeenCalled();
    element.fire("pointermove", touch(1, 30, 10));
    element.fire("pointerup", touch(1, 30, 10));
    expect(handler.toolDown.mock.calls).toEqual([[{ x: 20, y: 20 }]]);
    expect(handler.toolMove).toHaveBeenCalled();
    expect(handler.toolUp).toHaveBeenCalledTimes(1);
  });

  it("a finger that rests starts the tool, a tap is one dab", () => {
    element.fire("pointerdown", touch(1, 10, 10));
    vi.advanceTimersByTime(200);
    expect(handler.toolDown).toHaveBeenCalledTimes(1);
    element.fire("pointerup", touch(1, 10, 10));
    element.fire("pointerdown", touch(2, 10, 10));
    element.fire("pointerup", touch(2, 10, 10));
    expect(handler.toolDown).toHaveBeenCalledTimes(2);
    expect(handler.toolUp).toHaveBeenCalledTimes(2);
  });

  it("two fingers never paint: they move, zoom and twist", () => {
    element.fire("pointerdown", touch(1, 100, 100));
    element.fire("pointerdown", touch(2, 200, 100));
    element.fire("pointermove", touch(2, 300, 100));
    expect(handler.toolDown).not.toHaveBeenCalled();
    expect(handler.pan.mock.calls).toEqual([[100, 0]]);
    expect(handler.zoom.mock.calls).toEqual([[0.5, 400, 200]]);
    element.fire("pointermove", touch(2, 100, 300));
    expect(handler.twist.mock.lastCall![0]).toBeCloseTo(Math.PI / 2, 6);
    element.fire("pointerup", touch(2, 100, 300));
    element.fire("pointermove", touch(1, 0, 0));
    element.fire("pointerup", touch(1, 0, 0));
    expect(handler.toolDown).not.toHaveBeenCalled();
  });

  it("a second finger cancels what the first began", () => {
    element.fire("pointerdown", touch(1, 10, 10));
    element.fire("pointermove", touch(1, 40, 10));
    element.fire("pointerdown", touch(2, 200, 100));
    expect(handler.toolCancel).toHaveBeenCalledTimes(1);
    element.fire("pointerup", touch(2, 200, 100));
    element.fire("pointerup", touch(1, 40, 10));
    expect(handler.toolUp).not.toHaveBeenCalled();
  });
});

describe("pen", () => {
  const stroke = (x: number): void => {
    element.fire("pointerdown", pen(x, 10));
    element.fire("pointermove", pen(x + 5, 10));
    element.fire("pointerup", pen(x + 5, 10));
  };
  const leaves = (): void => element.fire("pointerleave", pen(0, 0, hovering));
  const palmDrags = (pointer: number): void => {
    element.fire("pointerdown", touch(pointer, 200, 200));
    vi.advanceTimersByTime(200);
    element.fire("pointermove", touch(pointer, 240, 230));
    element.fire("pointerup", touch(pointer, 240, 230));
  };
  const pinch = (): void => {
    element.fire("pointerdown", touch(1, 100, 100));
    element.fire("pointerdown", touch(2, 200, 100));
    element.fire("pointermove", touch(2, 300, 100));
    element.fire("pointerup", touch(2, 300, 100));
    element.fire("pointerup", touch(1, 100, 100));
  };
  const nothingMoved = (): void => {
    for (const name of ["orbit", "pan", "zoom", "twist"] as const)
      expect(handler[name], name).not.toHaveBeenCalled();
  };

  it("paints, and the hand that rests beside it does nothing", () => {
    element.fire("pointerdown", pen(10, 10));
    element.fire("pointerdown", touch(1, 200, 200));
    vi.advanceTimersByTime(200);
    element.fire("pointermove", touch(1, 230, 220));
    element.fire("pointermove", pen(15, 10));
    element.fire("pointerup", touch(1, 230, 220));
    element.fire("pointerup", pen(15, 10));
    expect(handler.toolDown.mock.calls).toEqual([[{ x: 20, y: 20 }]]);
    expect(handler.toolMove.mock.calls).toEqual([[[{ x: 30, y: 20 }]]]);
    expect(handler.toolUp).toHaveBeenCalledTimes(1);
    expect(handler.toolCancel).not.toHaveBeenCalled();
    nothingMoved();
  });

  it("in range is enough: also two parts of the hand neither paint nor move", () => {
    element.fire("pointermove", pen(10, 10, hovering));
    palmDrags(1);
    pinch();
    expect(handler.toolDown).not.toHaveBeenCalled();
    nothingMoved();
  });

  it("takes over from a hand that was there before it, which counts only after it was lifted", () => {
    element.fire("pointerdown", touch(1, 200, 200));
    element.fire("pointerdown", touch(2, 260, 200));
    element.fire("pointermove", pen(10, 10, hovering));
    element.fire("pointermove", touch(2, 300, 240));
    stroke(10);
    leaves();
    vi.advanceTimersByTime(10_000);
    element.fire("pointermove", touch(1, 100, 100));
    expect(handler.toolDown).toHaveBeenCalledTimes(1);
    nothingMoved();
    element.fire("pointerup", touch(1, 100, 100));
    element.fire("pointerup", touch(2, 300, 240));
    pinch();
    expect(handler.zoom).toHaveBeenCalledTimes(1);
  });

  it("ends what a finger has begun, and the finger's rest paints nothing", () => {
    element.fire("pointerdown", touch(1, 10, 10));
    element.fire("pointermove", touch(1, 40, 10));
    expect(handler.toolDown).toHaveBeenCalledTimes(1);
    element.fire("pointerdown", pen(100, 100));
    expect(handler.toolCancel).toHaveBeenCalledTimes(1);
    element.fire("pointermove", touch(1, 80, 10));
    element.fire("pointerup", touch(1, 80, 10));
    element.fire("pointermove", pen(110, 100));
    expect(handler.toolMove.mock.calls.slice(1)).toEqual([[[{ x: 220, y: 200 }]]]);
    element.fire("pointerup", pen(110, 100));
    expect(handler.toolUp).toHaveBeenCalledTimes(1);
  });

  it("a touch that only waits when the pen comes is no dab", () => {
    element.fire("pointerdown", touch(1, 200, 200));
    element.fire("pointermove", pen(10, 10, hovering));
    vi.advanceTimersByTime(500);
    element.fire("pointerup", touch(1, 200, 200));
    expect(handler.toolDown).not.toHaveBeenCalled();
  });

  it("counts as there between two strokes, and two fingers move the model as soon as it is away", () => {
    stroke(10);
    leaves();
    vi.advanceTimersByTime(300);
    pinch();
    nothingMoved();
    vi.advanceTimersByTime(200);
    pinch();
    expect(handler.zoom.mock.calls).toEqual([[0.5, 400, 200]]);
    expect(handler.pan.mock.calls).toEqual([[100, 0]]);
    expect(handler.toolDown).toHaveBeenCalledTimes(1);
  });

  it("that is gone without a word does not keep the fingers out, one that rests on the glass does", () => {
    element.fire("pointerdown", pen(10, 10));
    vi.advanceTimersByTime(60_000);
    pinch();
    nothingMoved();
    element.fire("pointerup", pen(10, 10));
    vi.advanceTimersByTime(5000);
    pinch();
    expect(handler.zoom).toHaveBeenCalledTimes(1);
  });

  it("once used has the tools that change something: one finger turns then, and a tap paints nothing", () => {
    palmDrags(1);
    expect(handler.toolDown).toHaveBeenCalledTimes(1); // without a pen, a finger paints
    stroke(10);
    leaves();
    vi.advanceTimersByTime(1000);
    palmDrags(1);
    expect(handler.toolDown).toHaveBeenCalledTimes(2);
    expect(handler.orbit.mock.calls).toEqual([[80, 60]]);
    element.fire("pointerdown", touch(1, 10, 10));
    element.fire("pointerup", touch(1, 10, 10));
    expect(handler.toolDown).toHaveBeenCalledTimes(2);
    handler.toolIsForPen.mockReturnValue(false);
    element.fire("pointerdown", touch(1, 10, 10));
    element.fire("pointerup", touch(1, 10, 10));
    expect(handler.toolDown).toHaveBeenCalledTimes(3);
  });

  it("leaves no circle of the brush behind", () => {
    element.fire("pointermove", pen(1, 1, hovering));
    leaves();
    expect(handler.hover.mock.calls).toEqual([[{ x: 2, y: 2 }], [null]]);
  });
});
