import { resolveObjectURL } from "node:buffer";
import { describe, expect, it } from "vitest";

import { usualReport, type ReportInput } from "../../../src/domain/reports";
import {
  previewRequest,
  ReportPreview,
  type ReportSettings,
} from "../../../src/features/reports/report-preview";

const usual = usualReport("en");
const logo = { name: "museum.png", type: "image/png" as const, data: "AAAA" };
const settings = (
  change: Partial<ReportInput> = {},
  more: Partial<ReportSettings> = {},
): ReportSettings => ({ input: { ...usual, ...change }, layers: [3, 5], logo, ...more });
const preview = (type = "application/pdf"): ReportPreview =>
  new ReportPreview(new Blob(["%PDF-1.7"], { type }), "pot-report.pdf", settings());

describe("The preview of a report", () => {
  it("is a PDF with the settings of the report", () => {
    expect(previewRequest(settings({ format: "docx", title: "Pot" }))).toMatchObject({
      format: "pdf",
      title: "Pot",
      layers: [3, 5],
      logo: "AAAA",
    });
  });

  it("differs from the report after each change that the report shows", () => {
    const shown = preview();
    for (const changed of [
      settings({ title: "Pot" }),
      settings({ language: "de" }),
      settings({ figures: [] }),
      settings({ sections: [...usual.sections].reverse() }),
      settings({}, { layers: [3] }),
      settings({}, { logo: null }),
      settings({}, { logo: { ...logo, data: "AAAB" } }),
    ])
      expect(shown.differs(changed)).toBe(true);
    shown.release();
  });

  it("does not differ if the report would be the same", () => {
    const shown = preview();
    for (const same of [settings(), settings({ format: "pdf" }), settings({ title: " " })])
      expect(shown.differs(same)).toBe(false);
    shown.release();
  });

  it("has a PDF until it is released, whatever type the answer had", async () => {
    const shown = preview("text/html");
    const blob = resolveObjectURL(shown.address);
    expect([blob?.type, await blob?.text()]).toEqual(["application/pdf", "%PDF-1.7"]);
    shown.release();
    expect(resolveObjectURL(shown.address)).toBeUndefined();
  });
});
