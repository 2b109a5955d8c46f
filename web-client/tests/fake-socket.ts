// A socket without a network. Tests read its sent messages and inject received ones.

import type { SocketLike } from "../src/net/socket";
import type { ClientMessage, ServerMessage, Welcome } from "../src/core/protocol.gen";

export class FakeSocket implements SocketLike {
  binaryType: BinaryType = "blob";
  bufferedAmount = 0;
  onopen: ((event: never) => void) | null = null;
  onmessage: ((event: { data: unknown }) => void) | null = null;
  onclose: ((event: { code: number; reason: string }) => void) | null = null;
  onerror: ((event: never) => void) | null = null;
  sent: ClientMessage[] = [];
  closed = false;

  constructor(
    readonly url: string,
    readonly protocol: string,
  ) {}

  send(data: string): void {
    this.sent.push(JSON.parse(data) as ClientMessage);
  }
  close(): void {
    this.closed = true;
  }

  /** Simulates the completed handshake. */
  open(): void {
    this.onopen?.(undefined as never);
  }
  receive(message: ServerMessage): void {
    this.onmessage?.({ data: JSON.stringify(message) });
  }
  receiveRaw(data: unknown): void {
    this.onmessage?.({ data });
  }
  /** Simulates the loss of the network. */
  lose(): void {
    this.onclose?.({ code: 1006, reason: "" });
  }

  sentOps(): string[] {
    return this.sent.map((message) => message.op);
  }
  of<Op extends ClientMessage["op"]>(op: Op): Extract<ClientMessage, { op: Op }>[] {
    return this.sent.filter(
      (message): message is Extract<ClientMessage, { op: Op }> => message.op === op,
    );
  }
}

export function welcome(strokes: Welcome["strokes"] = []): Welcome {
  return {
    op: "welcome",
    session: "00000000-0000-4000-8000-000000000001",
    user: "owner",
    role: "owner",
    model: {} as Welcome["model"],
    layers: [],
    looks: [],
    limits: {
      message_bytes: 65536,
      path_points: 4,
      view_size: 8192,
      views: 1,
      frames_in_flight: 2,
      messages_per_second: 200,
    },
    strokes,
  };
}
