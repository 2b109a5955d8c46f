// The agreement of two layers, as sentences and a table.

import { formatFixed, formatPercent } from "../../core/locale";
import type { Agreement, ClassAgreement } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { labelOf } from "../../domain/cells";
import { kappaMeaning } from "../../domain/kappa";
import { formatArea } from "../../domain/measure";
import { describeValue, type RecordLabels } from "../../session/layer-values";
import { texts } from "../../texts";

export const kMostClasses = 40; // the largest number of classes shown

export interface AgreementSummary {
  sentences: string[];
  rows: string[][]; // the first one is the head
  isCut: boolean;
}

const painted = (of: ClassAgreement): number =>
  of.area_first_m2 + of.area_second_m2 - of.area_both_m2;

/** Returns the name of a class. An observer may have named only a part of the classes. */
function className(key: number | null, layers: readonly Layer[], records: RecordLabels): string {
  if (key === null) return texts.cross_table.agreement.unpainted;
  const named = layers.find(({ palette }) => palette.points.some((p) => p.at === key && p.label));
  return describeValue(named ?? layers[0]!, key, records);
}

/** Returns the classes with the largest areas. "Not painted" is last. */
export function agreementSummary(
  { kappa, observed, expected, observed_painted: observedPainted, classes }: Agreement,
  first: Layer,
  second: Layer,
  records: RecordLabels,
): AgreementSummary {
  const words = texts.cross_table.agreement;
  const sentences = [
    kappa === null
      ? words.undefined
      : words.kappa(
          formatFixed(Math.round(kappa * 100) / 100 + 0, 2), // `+ 0` avoids "-0.00"
          words.meanings[kappaMeaning(kappa)],
        ),
    words.observed(formatPercent(observed), formatPercent(expected)),
    ...(observedPainted === null ? [] : [words.observed_painted(formatPercent(observedPainted))]),
    words.unpainted_counts,
  ];
  const sorted = [...classes].sort(
    (a, b) => Number(a.key === null) - Number(b.key === null) || painted(b) - painted(a),
  );
  const isCut = sorted.length > kMostClasses;
  const shown = isCut ? [...sorted.slice(0, kMostClasses - 1), sorted.at(-1)!] : sorted;
  const row = (of: ClassAgreement): string[] => [
    className(of.key, [first, second], records),
    formatPercent(of.iou),
    formatPercent(of.f1),
    formatArea(of.area_both_m2),
    formatArea(Math.max(0, of.area_first_m2 - of.area_both_m2)),
    formatArea(Math.max(0, of.area_second_m2 - of.area_both_m2)),
  ];
  const head = [
    words.class,
    "IoU",
    "F1",
    words.both,
    words.only_in(labelOf(first)),
    words.only_in(labelOf(second)),
  ];
  return { sentences, rows: [head, ...shown.map(row)], isCut };
}
