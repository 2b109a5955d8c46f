/** Has the browser save what is at an address of the server as a file. */
export function save_from(address: string, name: string): void {
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
}
