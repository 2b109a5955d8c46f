// Moves items to the trash of a project: asks the user first, and offers to undo the deletion.

import { ApiError } from "../net/api-error";
import type { Api } from "../net/api";
import type { BinKind, BinRestored } from "../core/protocol.gen";
import { ask } from "./dialog";
import { notices } from "./notices";
import { texts } from "../texts";

export interface Deletable {
  kind: BinKind;
  entry: string; // id of the entry in the trash
  name: string;
  project: string; // slug of the project
}

/**
 * Asks whether to move an item to the trash. The question includes the server's retention time of
 * the trash. Resolves to the user's decision.
 */
export async function askToTrash(
  api: Api,
  { name, project }: Deletable,
  words: { title: (name: string) => string; lead: string },
): Promise<boolean> {
  const days = await api
    .json("GET /projects/{project}/bin", { path: { project }, query: { limit: 1, offset: 0 } })
    .then(
      (trash) => trash.days,
      (error: unknown) => {
        if (!(error instanceof ApiError)) throw error;
        return null; // the deletion itself reports the problem
      },
    );
  return ask({
    heading: words.title(name),
    lead: `${words.lead} ${days === 0 ? texts.bin.not_kept : texts.bin.kept(days)}`,
    yes: texts.delete,
    danger: true,
  });
}

/**
 * Shows a notice about the deletion, with a button that restores the item. `cameBack` is called
 * after the restoration.
 */
export function tellTrashed(
  api: Api,
  gone: Deletable,
  cameBack: (restored: BinRestored) => void = () => {},
): void {
  const undo = async (): Promise<void> => {
    try {
      const restored = await api.json("POST /projects/{project}/bin/{entry}/restore", {
        path: { project: gone.project, entry: gone.entry },
      });
      notices.show("success", toldRestored(restored));
      cameBack(restored);
    } catch (error) {
      notices.error(error);
    }
  };
  notices.show("success", texts.bin.deleted[gone.kind](gone.name), "", {
    label: texts.model.undo,
    act: () => void undo(),
  });
}

export const toldRestored = ({ name, slug, former_slug: formerSlug }: BinRestored): string =>
  slug === undefined || formerSlug === undefined
    ? texts.bin.restored(name)
    : texts.bin.restored_as(name, formerSlug, slug);
