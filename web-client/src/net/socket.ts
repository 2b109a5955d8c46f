// What of a WebSocket is used here, so that a fake can stand in for it.

export const kOpenSocket = 1; // WebSocket.OPEN

export interface SocketLike {
  binaryType: BinaryType;
  readonly bufferedAmount: number;
  readonly readyState?: number; // as a WebSocket has it; absent: open
  onopen: ((event: never) => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: ((event: { code: number; reason: string }) => void) | null;
  onerror: ((event: never) => void) | null;
  send(data: string): void;
  close(code?: number, reason?: string): void;
}
