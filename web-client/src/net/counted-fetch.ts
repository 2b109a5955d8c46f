// How many requests of the page are under way stands in `data-requests` of the root element, so
// that tests in browsers wait for none in place of a time.

let underWay = 0;

function count(by: number): void {
  underWay += by;
  document.documentElement.dataset["requests"] = String(underWay);
}

/** As `fetch`; the request counts until its answer begins or fails. */
export async function countedFetch(input: string, init?: RequestInit): Promise<Response> {
  count(+1);
  try {
    return await fetch(input, init);
  } finally {
    count(-1);
  }
}
