// `data-requests` of the root element is the number of pending requests of the page, so that
// browser tests wait for zero instead of a fixed time.

let underWay = 0;

function count(by: number): void {
  underWay += by;
  document.documentElement.dataset["requests"] = String(underWay);
}

/** Like `fetch`; a request counts until its answer begins or fails. */
export async function countedFetch(input: string, init?: RequestInit): Promise<Response> {
  count(+1);
  try {
    return await fetch(input, init);
  } finally {
    count(-1);
  }
}
