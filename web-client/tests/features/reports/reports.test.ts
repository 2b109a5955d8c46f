import fc from "fast-check";
import { describe, expect, it } from "vitest";

import { Kept } from "../../../src/core/kept";
import { setLocale } from "../../../src/core/locale";
import type { ReportPart } from "../../../src/core/protocol.gen";
import {
  keptLogo,
  keptReport,
  keyOfView,
  kReportParts,
  logoType,
  reportInput,
  reportRequest,
  usualReport,
  type ReportInput,
} from "../../../src/domain/reports";
import { moved } from "../../../src/domain/tours";
import {
  fieldOf,
  partOf,
  problemsIn,
  without,
} from "../../../src/features/reports/report-problems";
import { Reports } from "../../../src/features/reports/reports";
import { Api } from "../../../src/net/api";
import { FileJobs } from "../../../src/session/file-jobs";
import { LayerJobs } from "../../../src/session/layer-jobs";
import { texts } from "../../../src/texts";

const words = texts.report_dialog;
const view = { id: 12 };
const usual = usualReport("en");
const changed = (change: Partial<ReportInput>): ReportInput => ({ ...usual, ...change });
const section = (part: ReportPart, change: object): ReportInput["sections"] =>
  usual.sections.map((each) => (each.part === part ? { ...each, ...change } : each));
const partsOf = (input: ReportInput): string[] => input.sections.map(({ part }) => part);

describe("The request for a report", () => {
  it("has all sections, the visible layers and four directions, and no empty texts", () => {
    expect(reportRequest(usual, [3, 5], null)).toEqual({
      format: "docx",
      language: "en",
      fields: [],
      sections: kReportParts.map((part) => ({ part })),
      layers: [3, 5],
      figures: ["front", "right", "back", "left"].map((direction) => ({ direction })),
      max_records: 100,
      record_pictures: true,
    });
  });

  it("has the chosen order, texts, rows, layers, scales and views", () => {
    const sections = moved(
      section("condition", { heading: " Damage ", text: "Stable.\n\nDry. " }),
      1,
      0,
    );
    const input = changed({
      format: "pdf",
      language: "de",
      title: " Pot ",
      subject: "Before the loan",
      author: "Ada",
      fields: [
        { id: 4, label: " Client ", value: " Museum " },
        { id: 2, label: " ", value: "" },
        { id: 3, label: "Place", value: "" },
      ],
      sections: sections.map((each) => ({ ...each, on: each.part !== "methods" })),
      layers: [5],
      figures: [
        { of: keyOfView(view), scale: "" },
        { of: "top", scale: "1 : 2.5" },
      ],
      records: "20",
      recordPictures: false,
    });
    const request = reportRequest(input, [3, 5], "AAAA");
    expect(request).toMatchObject({
      format: "pdf",
      language: "de",
      title: "Pot",
      subject: "Before the loan",
      author: "Ada",
      logo: "AAAA",
      layers: [5],
      figures: [{ view: "12" }, { direction: "top", scale: 2.5 }],
      max_records: 20,
      record_pictures: false,
    });
    expect(request.fields).toEqual([
      { label: "Client", value: "Museum" },
      { label: "Place", value: "" },
    ]);
    expect(request.sections!.slice(0, 2)).toEqual([
      { part: "condition", heading: "Damage", text: "Stable.\n\nDry." },
      { part: "object" },
    ]);
    expect(request.sections!.map(({ part }) => part)).not.toContain("methods");
  });

  it("has neither figures nor limits of records without these sections", () => {
    const sections = usual.sections.map((each) => ({ ...each, on: each.part === "object" }));
    const request = reportRequest(changed({ sections, records: "many" }), [], null);
    expect(Object.keys(request)).toEqual(["format", "language", "fields", "sections", "layers"]);
  });

  it("reads numbers as the page writes them", () => {
    try {
      setLocale("de", true, []);
      const input = changed({ figures: [{ of: "front", scale: "1 : 2,5" }] });
      expect(reportRequest(input, [], null).figures).toEqual([{ direction: "front", scale: 2.5 }]);
    } finally {
      setLocale("en", true, []);
    }
  });
});

describe("The choices for the next report", () => {
  it("keep what does not belong to one model", () => {
    const input = changed({
      format: "pdf",
      language: "es",
      title: "Pot",
      author: "Ada",
      fields: [{ id: 9, label: "Client", value: "Museum" }],
      sections: moved(section("measures", { on: false, heading: "Plan", text: "Clean it." }), 5, 0),
      layers: [5],
      figures: [
        { of: "top", scale: "1:50" },
        { of: keyOfView(view), scale: "" },
      ],
      records: "7",
      recordPictures: false,
    });
    const next = reportInput(JSON.parse(JSON.stringify(keptReport(input))), "en");
    expect(next).toMatchObject({
      format: "pdf",
      language: "es",
      title: "",
      author: "Ada",
      fields: [{ id: 0, label: "Client", value: "" }],
      layers: null,
      figures: [{ of: "top", scale: "1 : 50" }],
      records: "7",
      recordPictures: false,
    });
    expect(partsOf(next)).toEqual(partsOf(input));
    expect(next.sections[0]).toEqual({ part: "measures", on: false, heading: "Plan", text: "" });
  });

  it("are the usual ones if the storage contains something else", () => {
    for (const stored of [
      null,
      3,
      "x",
      [],
      { format: "odt", sections: {}, figures: 4, records: -1 },
    ])
      expect(reportInput(stored, "de")).toEqual(usualReport("de"));
    const twice = [{ part: "methods" }, { part: "methods" }, { part: "cover" }];
    const input = reportInput({ sections: twice, figures: [{ direction: "up" }] }, "en");
    expect(partsOf(input)[0]).toBe("methods");
    expect([...partsOf(input)].sort()).toEqual([...kReportParts].sort());
    expect(input.figures).toEqual([]);
  });

  it("make a valid report whatever the storage contains", () => {
    fc.assert(
      fc.property(fc.anything(), (stored) => {
        expect([...problemsIn(reportInput(stored, "en"), []).keys()]).toEqual([]);
      }),
    );
  });
});

describe("The problems of a report", () => {
  const found = (change: Partial<ReportInput>): [string, string][] => [
    ...problemsIn(changed(change), [view]),
  ];

  it("are none at first", () => expect(found({})).toEqual([]));

  it("stand at their fields", () => {
    const fields = [
      { id: 7, label: " ", value: "1927.14" },
      { id: 8, label: "", value: "" },
    ];
    expect(found({ fields })).toEqual([["field:7:label", words.wrong_label]]);
    const off = usual.sections.map((each) => ({ ...each, on: false }));
    expect(found({ sections: off })).toEqual([["sections", words.no_sections]]);
    expect(found({ sections: section("condition", { text: "ü".repeat(20_001) }) })).toEqual([
      ["section:condition:text", words.long_text("20,001", "20,000")],
    ]);
    expect(found({ sections: section("condition", { text: "😀".repeat(20_000) }) })).toEqual([]);
    expect(found({ layers: Array.from({ length: 101 }, (_, id) => id) })).toEqual([
      ["layers", words.many_layers(100)],
    ]);
    const figures = [
      { of: "front", scale: "big" },
      { of: keyOfView(view), scale: "1:2" },
      { of: keyOfView({ id: 13 }), scale: "" },
    ];
    expect(found({ figures })).toEqual([
      ["figure:front", texts.figures.wrong_scale],
      ["figure:view:13", words.no_view],
    ]);
  });

  it.each(["", "-1", "1001", "1.5", "many"])("include %j as the number of records", (records) => {
    expect(found({ records })).toEqual([["records", words.wrong_records(0, "1,000")]]);
    expect(found({ records, sections: section("findings", { on: false }) })).toEqual([]);
  });

  it("of the server are shown at the field of the request", () => {
    const sent = changed({
      fields: [
        { id: 5, label: "", value: "" },
        { id: 6, label: "Client", value: "Museum" },
      ],
      sections: section("object", { on: false }),
      figures: [
        { of: "top", scale: "" },
        { of: keyOfView(view), scale: "" },
      ],
    });
    const at = (field: string, now = sent): string =>
      fieldOf({ status: 422, title: "Invalid", field }, sent, now);
    expect(at("sections[0].part")).toBe("section:condition");
    expect(at("sections[1].text")).toBe("section:figures:text");
    expect(at("sections")).toBe("sections");
    expect(at("figures[1].scale")).toBe("figure:view:12");
    expect(at("figures[9].view")).toBe("figures");
    expect(at("fields[0].value")).toBe("field:6:value");
    expect(at("fields[0].label")).toBe("field:6:label");
    expect([at("logo"), at("max_records"), at("layers[1]")]).toEqual(["logo", "records", "layers"]);
    expect([at(""), at("else")]).toEqual(["", ""]);
    // the user has removed the field while the server made the report
    expect(at("figures[1].scale", changed({ figures: [] }))).toBe("figures");
    expect(at("fields[0].label", changed({ fields: [] }))).toBe("fields");
  });

  it("belong to the section that shows their field, and go with a change of it", () => {
    expect(
      ["section:methods:text", "figure:view:12", "figures", "records", "logo"].map(partOf),
    ).toEqual(["methods", "figures", "figures", "findings", null]);
    const problems = new Map(
      ["", "figure:top", "figures", "title"].map((field) => [field, "Wrong"]),
    );
    expect([...without(problems, ["figure:top"]).keys()]).toEqual(["figures", "title"]);
    const ofRow = new Map([
      ["field:1:label", "Wrong"],
      ["field:10:label", "Wrong"],
    ]);
    expect([...without(ofRow, ["field:1"]).keys()]).toEqual(["field:10:label"]);
  });
});

describe("The logo", () => {
  it("is a PNG or JPEG by its first bytes", () => {
    const png = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 1];
    expect(logoType(new Uint8Array(png))).toBe("image/png");
    expect(logoType(new Uint8Array([0xff, 0xd8, 0xff, 0xe0]))).toBe("image/jpeg");
    for (const bytes of [[], [0xff, 0xd8], png.slice(0, 7), [0x47, 0x49, 0x46]])
      expect(logoType(new Uint8Array(bytes))).toBeNull();
  });

  it("from the storage cannot be another address", () => {
    const logo = { name: "museum.png", type: "image/png", data: "AAAA" };
    expect(keptLogo(logo)).toEqual(logo);
    for (const wrong of [
      null,
      { ...logo, type: "image/svg+xml" },
      { ...logo, data: 'A" onload="' },
    ])
      expect(keptLogo(wrong)).toBeNull();
  });

  it("that the storage cannot take stays in memory, and the stored one does not return", () => {
    const stored = new Map([["logo", '"old"']]);
    let room = true;
    const storage = {
      getItem: (name: string) => stored.get(name) ?? null,
      setItem: (name: string, text: string) => {
        if (!room) throw new Error("full");
        stored.set(name, text);
      },
      removeItem: (name: string) => void stored.delete(name),
    } as unknown as Storage;
    const kept = new Kept(() => storage, "logo", "");
    kept.value = "newer";
    expect(new Kept(() => storage, "logo", "").value).toBe("newer");
    room = false;
    kept.value = "too large";
    expect([kept.value, new Kept(() => storage, "logo", "").value]).toEqual(["too large", ""]);
  });
});

describe("The reports of the open model", () => {
  it("are jobs of the server", async () => {
    const calls: { path: string; body: unknown; prefer: string | undefined }[] = [];
    const api = new Api(async (path, init) => {
      const headers = init!.headers as Record<string, string>;
      const body: unknown = init!.body ? JSON.parse(init!.body as string) : undefined;
      calls.push({ path, body, prefer: headers["Prefer"] });
      return new Response(
        JSON.stringify({ id: 5, kind: "report", state: "cancelled", progress: 0, message: "" }),
        { status: 202 },
      );
    });
    const files = new FileJobs(api, new LayerJobs(api, "9", () => {}));
    const reports = new Reports(api, "9", files);
    const key = await reports.make("Report: Pot", "Ready", reportRequest(usual, [], null));
    expect(files.awaited).toBe(key);
    expect(calls[0]).toMatchObject({
      path: "/api/v1/models/9/report",
      body: { format: "docx", max_records: 100 },
      prefer: "respond-async",
    });
  });

  it("have a draft only while the model is open, and choices without a storage", () => {
    const api = new Api(async () => new Response("{}", { status: 500 }));
    const files = new FileJobs(api, new LayerJobs(api, "9", () => {}));
    const reports = new Reports(api, "9", files);
    expect([reports.draft, reports.choices.value]).toEqual([null, null]);
    reports.draft = changed({ title: "Pot" });
    reports.choices.value = keptReport(reports.draft);
    expect(reportInput(reports.choices.value, "en").title).toBe("");
    expect(new Reports(api, "10", files).draft).toBeNull();
  });
});
