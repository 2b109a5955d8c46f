// The address of a live connection at another node of the site.

/**
 * Returns the address of the live connection `own` at the node with the address `node`. A node with
 * another origin than the page, or with an invalid address, is ignored, so no message can make the
 * page send its edits to another site. In this case, the page uses the address of the site, which
 * leads to the right node.
 */
export function addressAtNode(own: string, node: string | undefined): string {
  if (node === undefined) return own;
  const home = new URL(own);
  let at: URL;
  try {
    at = new URL(node, `${home.protocol === "wss:" ? "https:" : "http:"}//${home.host}`);
  } catch {
    return own;
  }
  const scheme = { "http:": "ws:", "https:": "wss:", "ws:": "ws:", "wss:": "wss:" }[at.protocol];
  if (scheme !== home.protocol || at.host !== home.host) return own;
  const path = at.pathname.replace(/\/+$/, "");
  return `${home.protocol}//${home.host}${path}${home.pathname}${home.search}`;
}
