// Keeps the number of the page's pending requests in `data-requests` of the root element. Browser
// tests can wait for zero instead of a fixed time.

let underWay = 0;

function count(by: number): void {
  underWay += by;
  document.documentElement.dataset["requests"] = String(underWay);
}

/** Works like `fetch`. A request is pending until its response begins or fails. */
export async function countedFetch(input: string, init?: RequestInit): Promise<Response> {
  count(+1);
  try {
    return await fetch(input, init);
  } finally {
    count(-1);
  }
}
