// The tree of the parts of a model, from their folders.

import type { ModelPart } from "../../core/protocol.gen";
import { pageLocale } from "../../core/locale";

/** A part with its number, which is its position in the list of the model. */
export interface NumberedPart extends ModelPart {
  number: number;
}

export interface PartFolder {
  name: string; // "" for the root
  path: string;
  folders: PartFolder[];
  parts: NumberedPart[];
}

/** Orders "Part 2" before "Part 10". */
const compareNames = (a: string, b: string): number =>
  a.localeCompare(b, pageLocale(), { numeric: true });

export function partTree(parts: readonly ModelPart[]): PartFolder {
  const root: PartFolder = { name: "", path: "", folders: [], parts: [] };
  parts.forEach((part, number) => {
    let folder = root;
    for (const name of part.folder === "" ? [] : part.folder.split("/")) {
      const path = folder.path === "" ? name : `${folder.path}/${name}`;
      let inner = folder.folders.find((each) => each.name === name);
      if (!inner) {
        inner = { name, path, folders: [], parts: [] };
        folder.folders.push(inner);
      }
      folder = inner;
    }
    folder.parts.push({ ...part, number });
  });
  sort(root);
  return root;
}

function sort(folder: PartFolder): void {
  folder.folders.sort((a, b) => compareNames(a.name, b.name));
  folder.parts.sort((a, b) => compareNames(a.name, b.name) || a.number - b.number);
  folder.folders.forEach(sort);
}

export const pathOf = ({ folder, name }: ModelPart): string =>
  folder === "" ? name : `${folder}/${name}`;

/** Returns the parts in a folder and in its folders. */
export const partsIn = (folder: PartFolder): NumberedPart[] => [
  ...folder.parts,
  ...folder.folders.flatMap(partsIn),
];

/** Returns the box of some parts, or null without parts. */
export function boundsOf(parts: readonly ModelPart[]): ModelPart["bounds"] | null {
  if (parts.length === 0) return null;
  const of = (pick: "min" | "max"): [number, number, number] => {
    const at = (axis: 0 | 1 | 2): number =>
      Math[pick](...parts.map(({ bounds }) => bounds[pick][axis]));
    return [at(0), at(1), at(2)];
  };
  return { min: of("min"), max: of("max") };
}
