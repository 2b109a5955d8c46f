// <strata-nodes-dialog>: the nodes of the site, for administrators. The list is read again every
// few seconds while the dialog is open.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { loadShare, modelsShown, shortAddress } from "../../domain/site-nodes";
import { toldAgo } from "../../domain/times";
import { formatCount, formatFixed, formatList } from "../../core/locale";
import type { SiteNode } from "../../core/protocol.gen";
import "../../ui/dialog";
import { styled } from "../../ui/styled";
import { chipStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.nodes;
const kReadEveryMs = 5000;
const kModelsShown = 3;

@customElement("strata-nodes-dialog")
export class StrataNodesDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  @state() private _nodes: readonly SiteNode[] | null = null;
  @state() private _here = ""; // the node that sent the list
  @state() private _problem = "";
  private _timer = 0;

  static override styles = [
    sharedStyles,
    chipStyles,
    css`
      .scroll {
        overflow-x: auto;
      }
      table {
        width: 100%;
        border-collapse: collapse;
      }
      th,
      td {
        padding: var(--space-2) var(--space-3) var(--space-2) 0;
        text-align: start;
        vertical-align: top;
      }
      th {
        font-size: var(--text-tiny);
        color: var(--ink-soft);
      }
      td {
        border-top: var(--edge) solid var(--line);
      }
      td b {
        font-weight: 600;
        overflow-wrap: anywhere;
      }
      td .hint {
        display: block;
        overflow-wrap: anywhere;
      }
      .chip.draining {
        background: var(--warn-soft);
        color: var(--warn);
      }
      .chip.lost {
        background: var(--danger-soft);
        color: var(--danger);
      }
      .chip.here {
        background: var(--accent-soft);
        color: var(--accent);
      }
      .load {
        width: 5rem;
        height: 0.375rem;
        margin: var(--space-2) 0 var(--space-1);
        border-radius: var(--radius-round);
        background: var(--line);
        overflow: hidden;
      }
      .load > div {
        height: 100%;
        background: var(--accent);
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.read();
    this._timer = window.setInterval(() => void this.read(), kReadEveryMs);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    clearInterval(this._timer);
  }

  /** Reads the list. After a failure, the dialog keeps the previous list until the next read. */
  private async read(): Promise<void> {
    try {
      const found = await this.api.json("GET /nodes", { query: { limit: 1000 } });
      this._nodes = found.nodes;
      this._here = found.this_node ?? "";
      this._problem = "";
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
      this._problem = error.message;
    }
  }

  override render(): TemplateResult {
    const { _nodes: nodes, _problem: problem } = this;
    return html`<strata-dialog broad heading=${words.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      ${
        nodes
          ? nodes.length === 0
            ? html`<p>${words.alone}</p>`
            : this.table(nodes)
          : html`<p class="hint" role="status" ?hidden=${problem !== ""}>${texts.loading}</p>`
      }
      ${problem ? html`<p class="error" role="alert">${problem}</p>` : nothing}
    </strata-dialog>`;
  }

  private table(nodes: readonly SiteNode[]): TemplateResult {
    return html`<p class="hint">${words.lead}</p>
      <div class="scroll" tabindex="0" role="group" aria-label=${words.title}>
        <table>
          <thead>
            <tr>
              <th scope="col">${words.node}</th>
              <th scope="col">${words.state}</th>
              <th scope="col">${words.load}</th>
              <th scope="col">${words.models}</th>
              <th scope="col">${words.participants}</th>
            </tr>
          </thead>
          <tbody>
            ${repeat(
              nodes,
              ({ id }) => id,
              (node) => this.row(node, nodes),
            )}
          </tbody>
        </table>
      </div>`;
  }

  private row(node: SiteNode, nodes: readonly SiteNode[]): TemplateResult {
    const share = loadShare(node, nodes);
    const { names, others } = modelsShown(node, kModelsShown);
    const lease =
      node.state === "lost" ? words.lease_over : words.lease(formatFixed(node.lease_s, 1));
    return html`<tr>
      <td>
        <b>${shortAddress(node.url)}</b>
        ${node.id === this._here ? html`<span class="chip here">${words.here}</span>` : nothing}
        <span class="hint">${words.about(node.version, node.gpu)}</span>
        <span class="hint">${words.started(toldAgo(node.started))}</span>
      </td>
      <td>
        <span class="chip ${node.state}" title=${words.state_hints[node.state]}>${words.states[node.state]}</span>
        <span class="hint">${lease}</span>
      </td>
      <td>
        <div class="load" aria-hidden="true"><div ${styled({ width: `${share * 100}%` })}></div></div>
        <span>${words.cores(formatFixed(node.cores_used, 1))}</span>
      </td>
      <td>
        ${words.open_models(node.open_models)}
        <span class="hint">${names.length > 0 ? formatList([...names, ...(others > 0 ? [words.more(others)] : [])]) : nothing}</span>
      </td>
      <td>${formatCount(node.participants)}</td>
    </tr>`;
  }
}
