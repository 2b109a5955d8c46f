import { describe, expect, it } from "vitest";
import type { TemplateResult } from "lit";
import { StrataRolloutDialog } from "../../../src/features/figures/rollout-dialog";
import type { ModelSession } from "../../../src/session/model-session";

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
});
