// Sets style properties individually through the style object of an element. Lit's own styleMap
// first writes a style attribute, which the content security policy forbids.

import { noChange, type ElementPart } from "lit";
import { directive, Directive, PartType, type PartInfo } from "lit/directive.js";

type Properties = Readonly<Record<string, string | number | null | undefined>>;

class StyledDirective extends Directive {
  private _known = new Set<string>();

  constructor(part: PartInfo) {
    super(part);
    if (part.type !== PartType.ELEMENT)
      throw new Error("styled() belongs in the element, not in an attribute");
  }

  render(_properties: Properties): symbol {
    return noChange;
  }

  override update(part: ElementPart, [properties]: [Properties]): symbol {
    const { style } = part.element as HTMLElement;
    for (const name of this._known) if (!(name in properties)) style.removeProperty(name);
    this._known = new Set(Object.keys(properties));
    for (const [name, value] of Object.entries(properties)) {
      if (value === null || value === undefined) style.removeProperty(name);
      else style.setProperty(name, String(value));
    }
    return noChange;
  }
}

/** A directive for templates: `<div ${styled({ width: "12px" })}>`. */
export const styled = directive(StyledDirective);
