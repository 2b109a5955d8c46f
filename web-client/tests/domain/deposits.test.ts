import { describe, expect, it } from "vitest";
import { draftOf, fieldOf, kNewCreator, recordOf } from "../../src/domain/deposits";
import type { DepositRecord } from "../../src/core/protocol.gen";

const kRecord: DepositRecord = {
  titles: [
    { title: "A", language: "en" },
    { title: "B", kind: "translated" },
  ],
  creators: [
    {
      name: "Muster, Ada",
      orcid: "https://orcid.org/0000-0002-1825-0097",
      affiliations: [{ name: "Museum" }],
    },
    { kind: "organization", name: "Museum" },
  ],
  publisher: { name: "Zenodo", ror: "https://ror.org/04wxnsj81" },
  year: 2026,
  rights: [{ license: "CC-BY-4.0", uri: "https://creativecommons.org/licenses/by/4.0/" }],
  funding: [{ funder: { name: "F" } }],
};

describe("the form for the metadata of a project", () => {
  it("keeps everything that it does not show", () => {
    expect(recordOf(draftOf(kRecord), kRecord)).toEqual({
      ...kRecord,
      creators: [{ ...kRecord.creators![0], orcid: "0000-0002-1825-0097" }, kRecord.creators![1]],
    });
  });

  it("changes and removes members", () => {
    const draft = draftOf(kRecord);
    const changed = recordOf(
      {
        ...draft,
        title: " New ",
        publisher: "",
        year: "",
        license: "https://example.org/l",
        creators: [{ ...draft.creators[1]!, name: "House" }, kNewCreator],
      },
      kRecord,
    );
    expect(changed.titles).toEqual([{ title: "New", language: "en" }, kRecord.titles![1]]);
    expect(changed.creators).toEqual([{ kind: "organization", name: "House" }]);
    expect(changed.rights).toEqual([{ uri: "https://example.org/l" }]);
    expect(changed).not.toHaveProperty("publisher");
    expect(changed).not.toHaveProperty("year");
    expect(changed.funding).toEqual(kRecord.funding);
  });

  it("is empty without a record, and makes an empty record", () => {
    expect(draftOf({}).creators).toEqual([kNewCreator]);
    expect(recordOf(draftOf({}), {})).toEqual({});
  });

  it("finds the field that the server names", () => {
    expect(fieldOf("creators[1].orcid")).toBe("creator_orcid_1");
    expect(fieldOf("creators")).toBe("creator_name_0");
    expect(fieldOf("rights[0].license")).toBe("license");
    expect(fieldOf("funding[0].award_uri")).toBe("");
  });
});
