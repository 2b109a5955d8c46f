/** Has the browser save what is at an address of the server as a file. */
export function save_from(address: string, name: string): void {
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
}

/** The same of what the page has. */
export function save_blob(blob: Blob, name: string): void {
  const address = URL.createObjectURL(blob);
  save_from(address, name);
  setTimeout(() => URL.revokeObjectURL(address), 60_000); // once the browser has begun to read it
}
