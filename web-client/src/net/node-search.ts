// Looks for a node that can save the model while the node of the page has lost its database. The
// page keeps its connection, which still draws the model, until a second connection gets a welcome.
// The node of that connection has taken over the model. The search begins at the address of the
// site, and follows each message `moved` once.

import { parse_server_message, type ServerMessage } from "../core/protocol.gen";
import { retryDelayMs } from "./resender";
import type { SocketLike } from "./socket";

export interface NodeSearchHost {
  /** Begins a connection at the node with this address, or else at the address of the site. */
  connect(node: string | undefined): SocketLike;
  hello(socket: SocketLike): void;
  /** The search has ended. The host takes over the socket, which has received this welcome. */
  found(socket: SocketLike, welcome: string): void;
  random(): number;
}

export class NodeSearch {
  private _socket: SocketLike | null = null;
  private _timer: ReturnType<typeof setTimeout> | null = null;
  private _attempts = 0;
  // The node that has the model, according to the last answer. Used for one attempt, because two
  // nodes may refer to each other.
  private _node: string | undefined;

  constructor(
    private readonly _host: NodeSearchHost,
    private readonly _openingMs: number,
  ) {}

  start(): void {
    this.stop();
    this._attempts = 0;
    this._node = undefined;
    this.later();
  }

  stop(): void {
    if (this._timer) clearTimeout(this._timer);
    this._timer = null;
    const socket = this._socket;
    this._socket = null;
    socket?.close(1000, "not needed");
  }

  private later(): void {
    const delayMs = retryDelayMs(this._attempts, this._host.random());
    this._attempts += 1;
    this._timer = setTimeout(() => this.attempt(), delayMs);
  }

  private attempt(): void {
    const node = this._node;
    this._node = undefined;
    const socket = this._host.connect(node);
    socket.binaryType = "arraybuffer";
    this._socket = socket;
    const isNewest = (): boolean => socket === this._socket;
    socket.onopen = () => {
      if (isNewest()) this._host.hello(socket);
    };
    socket.onmessage = ({ data }) => {
      if (isNewest()) this.onMessage(socket, data);
    };
    socket.onclose = () => {
      if (isNewest()) this.fail();
    };
    socket.onerror = () => {}; // the browser then sends a close event
    this._timer = setTimeout(() => this.fail(), this._openingMs);
  }

  private onMessage(socket: SocketLike, data: unknown): void {
    const message = typeof data === "string" ? parsed(data) : undefined;
    if (message?.op === "welcome") {
      this._socket = null; // stop() must not close this socket
      this.stop();
      this._host.found(socket, data as string);
    } else if (message?.op === "moved" || message?.op === "database") {
      // That node cannot save the model either.
      if (message.op === "moved") this._node = message.url;
      this.fail();
    }
  }

  private fail(): void {
    this.stop();
    this.later();
  }
}

function parsed(text: string): ServerMessage | undefined {
  try {
    return parse_server_message(text);
  } catch {
    return undefined;
  }
}
