/** Downloads the content at an address of the server as a file. */
export function saveFrom(address: string, name: string): void {
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
}

/** Saves data of the page as a file. */
export function saveBlob(blob: Blob, name: string): void {
  const address = URL.createObjectURL(blob);
  saveFrom(address, name);
  // by this time, the browser has begun to read the data
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}
