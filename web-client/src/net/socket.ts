// The part of WebSocket that this page uses. Tests can replace it by a fake.

export const kOpenSocket = 1; // WebSocket.OPEN

export interface SocketLike {
  binaryType: BinaryType;
  readonly bufferedAmount: number;
  readonly readyState?: number; // as in WebSocket; open if absent
  onopen: ((event: never) => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: ((event: { code: number; reason: string }) => void) | null;
  onerror: ((event: never) => void) | null;
  send(data: string): void;
  close(code?: number, reason?: string): void;
}
