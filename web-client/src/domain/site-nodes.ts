// The nodes of a site, for the list that administrators see.

import type { SiteNode } from "../core/protocol.gen";

/** Returns the part of a node's address that differs from the addresses of the other nodes. */
export function shortAddress(url: string): string {
  try {
    const { host, pathname } = new URL(url);
    return `${host}${pathname.replace(/\/+$/, "")}`;
  } catch {
    return url;
  }
}

/**
 * Returns the load of a node, from 0 to 1, compared with the busiest node. The scale
 * has at least one processor core, so the bars are short if the site is almost idle.
 */
export function loadShare(node: SiteNode, nodes: readonly SiteNode[]): number {
  const scale = Math.max(1, ...nodes.map(({ cores_used: cores }) => cores));
  return Math.min(1, node.cores_used / scale);
}

/** Returns the names of the first models, and the number of the others. */
export function modelsShown(
  { models, models_total: total }: Pick<SiteNode, "models" | "models_total">,
  most: number,
): { names: string[]; others: number } {
  const names = models.slice(0, most).map(({ id, name }) => name || String(id));
  return { names, others: Math.max(0, total - names.length) };
}
