// Looks for a node that can save the model while the node of the page has lost its database. The
// page keeps its connection, which still draws the model, until a second connection at the address
// of the site gets a welcome. The node of that connection has taken over the model.

import { parse_server_message, type ServerMessage } from "../core/protocol.gen";
import { retryDelayMs } from "./resender";
import type { SocketLike } from "./socket";

export interface NodeSearchHost {
  /** Begins a connection at the address of the site. */
  connect(): SocketLike;
  hello(socket: SocketLike): void;
  /** The search has ended. The host takes over the socket, which has received this welcome. */
  found(socket: SocketLike, welcome: string): void;
  random(): number;
}

export class NodeSearch {
  private _socket: SocketLike | null = null;
  private _timer: ReturnType<typeof setTimeout> | null = null;
  private _attempts = 0;

  constructor(
    private readonly _host: NodeSearchHost,
    private readonly _openingMs: number,
  ) {}

  start(): void {
    this.stop();
    this._attempts = 0;
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
    const socket = this._host.connect();
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
    const op = typeof data === "string" ? opOf(data) : undefined;
    if (op === "welcome") {
      this._socket = null; // stop() must not close this socket
      this.stop();
      this._host.found(socket, data as string);
    } else if (op === "moved" || op === "database") {
      this.fail(); // that node cannot save the model either
    }
  }

  private fail(): void {
    this.stop();
    this.later();
  }
}

function opOf(text: string): ServerMessage["op"] | undefined {
  try {
    return parse_server_message(text).op;
  } catch {
    return undefined;
  }
}
