// Drops a column with its values after a confirmation.

import { labelOf } from "../../domain/cells";
import type { Column } from "../../core/types";
import { kAsItIs } from "../../net/api";
import type { ModelSession } from "../../session/model-session";
import { texts } from "../../texts";
import { ask } from "../../ui/dialog";
import { notices } from "../../ui/notices";

const words = texts.tables;

export async function dropColumn(
  session: ModelSession,
  tableId: number,
  column: Column,
): Promise<void> {
  const sure = await ask({
    heading: words.drop_title(labelOf(column)),
    lead: words.drop_lead,
    yes: words.drop,
    danger: true,
  });
  if (!sure) return;
  try {
    await session.api.send("DELETE /tables/{table}/columns/{column}", {
      path: { table: tableId, column: column.id },
      header: kAsItIs,
    });
    await session.tables.reload(tableId);
  } catch (error) {
    notices.error(error);
  }
}
