// Cases in a real browser, which @playwright/test runs. The cases of a file are one sequence on one
// server, in their order. The first failure ends the sequence.
import { Browser, require_browser } from "./browser.mjs";
import { load_module } from "./modules.mjs";
import { StrataServer } from "./strata-server.mjs";

require_browser();
const playwright = load_module("@playwright/test");

export const test = playwright.test.extend({
  demo: [true, { scope: "worker", option: true }], // whether the server has the demo project
  server: [
    async ({ demo }, use) => {
      const server = new StrataServer({ demo });
      try {
        await server.start();
        await use(server);
      } finally {
        await server.remove();
      }
    },
    { scope: "worker" },
  ],
  /** The page of a user, as a `Browser`. */
  desk: [
    async ({ server: _server }, use) => {
      const desk = await Browser.open();
      await use(desk);
      await desk.close();
    },
    { scope: "worker" },
  ],
  page: ({ desk }, use) => use(desk.page),
});

/** Attaches the server's log after a failed case, in addition to the screenshot. */
export async function attach_log(info, server) {
  if (server && info.status !== info.expectedStatus)
    await info.attach("log of the server", {
      body: server.end_of_log(),
      contentType: "text/plain",
    });
}

/** Adds the last case of a file. */
export function ends_well({ complaints = [], words = [] } = {}) {
  test("the page has nothing to complain of, and the server ends with a clean log", async ({
    desk,
    server,
  }) => {
    desk.assert_no_complaints(complaints);
    playwright.expect(await server.signal("SIGTERM")).toBe(0);
    server.assert_clean_log(words);
  });
}
