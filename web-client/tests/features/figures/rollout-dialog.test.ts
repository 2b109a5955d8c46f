import { describe, expect, it, vi } from "vitest";
import type { TemplateResult } from "lit";
import { StrataRolloutDialog } from "../../../src/features/figures/rollout-dialog";
import { kNewRollout } from "../../../src/features/figures/rollout-request";
import type { PicturePainting } from "../../../src/session/picture/picture-painting";
import type { ModelSession } from "../../../src/session/model-session";

// The field needs a browser when it is loaded.
vi.mock("../../../src/session/fields/value-picker", () => ({}));

/** Fires an event of the outermost element of a template. */
function fire({ strings, values }: TemplateResult, event: string): void {
  const at = strings.findIndex((text) => text.endsWith(`@${event}=`));
  (values[at] as () => void)();
}

describe("the dialog for rollouts", () => {
  it("fires `closed`, so its owner removes it", () => {
    const dialog = new StrataRolloutDialog();
    dialog.session = { model: null } as ModelSession;
    let closed = 0;
    dialog.addEventListener("closed", () => ++closed);
    fire(dialog.render(), "closed");
    expect(closed).toBe(1);
  });

  it("discards parts on another sheet, but not on a new picture of the same sheet", async () => {
    let radius = 40;
    let discarded = 0;
    const dialog = new StrataRolloutDialog();
    dialog.session = {
      model: { bounds: { min: [0, 0, 0], max: [1, 1, 1] }, up: "z" },
      modelId: "pot",
      figures: { draft: { rollout: kNewRollout } },
      painting: {
        brush: { width: { mm: 5 } },
        areaTarget: () => ({ layer: { id: 7 }, paint: {} }),
      },
      views: { content: () => ({}) },
      api: {
        json: (call: string) =>
          call === "POST /models/{model}/rollout"
            ? Promise.resolve({ axis: {}, radius, width: 100, height: 100, mm_per_pixel: 1 })
            : new Promise(() => {}), // the edit takes long
        blob: () => Promise.resolve(new Blob()),
      },
    } as unknown as ModelSession;
    // Without a page, the dialog is not rendered.
    Object.defineProperties(dialog, {
      isConnected: { value: true },
      scheduleUpdate: { value: () => {} },
      renderRoot: { value: { querySelector: () => ({ discard: () => ++discarded }) } },
    });
    dialog.connectedCallback();
    const { _painting: painting } = dialog as unknown as { _painting: PicturePainting };
    await painting.redraw();
    painting.paint(
      { part: { stroke: { path: [[0, 0]], radius: 1 } }, color: null },
      () => new Promise(() => {}), // takes long
    );
    const before = discarded;
    await painting.redraw();
    expect([discarded - before, painting.waiting.length]).toEqual([0, 1]);
    radius = 41;
    await painting.redraw();
    expect([discarded - before, painting.waiting.length]).toEqual([1, 0]);
  });
});
