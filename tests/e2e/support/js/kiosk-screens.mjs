// Every screen of a kiosk, with a way to open it, for the sheet of all screens (contact_sheet.mjs).
// kiosk_test.mjs tests the screens.
import { wait_for } from "./strata-server.mjs";

const kIdle_s = 30; // time without a touch until the page asks whether a visitor is still there

/**
 * Returns the screens in this order and in the first language of the tour (make_kiosk_site). The
 * tour's link is revoked at the end. The functions control the page's clock, starting with the
 * first screen.
 */
export function kiosk_screens_of({ page }, server, { path, kiosk }) {
  const button = (name) => page.getByRole("button", { name, exact: true });
  const heading = (name) => page.getByRole("heading", { name, exact: true });
  const begin = page.getByRole("button", { name: /^Touch to begin/ });
  const card = page.locator(".card");
  const live = () => page.locator("strata-kiosk-stage canvas.live[data-still=true]").waitFor();
  const pass_until = (condition, what) =>
    wait_for(async () => (await page.clock.fastForward(2000), condition()), what);
  return [
    {
      name: "kiosk: nobody is there",
      start: async () => {
        await page.clock.install();
        await page.goto(server.url + path);
        await begin.waitFor();
        await live();
      },
    },
    {
      name: "kiosk: a stop",
      start: async () => {
        await begin.click();
        await begin.waitFor({ state: "detached" });
        await heading("The pot from the well").waitFor();
        await live();
      },
    },
    {
      name: "kiosk: layers and records of a stop",
      start: async () => {
        await button("Next").click();
        await heading("Fourteen sherds").waitFor();
        await live();
      },
    },
    {
      name: "kiosk: card of a record",
      start: async () => {
        await button("Sherd 3").click();
        await card.locator("img").first().waitFor();
      },
    },
    {
      name: "kiosk: enlarged picture",
      start: async () => {
        await card.getByRole("button", { name: /^Enlarge: / }).click();
        await wait_for(
          () => page.locator(".enlarged img").evaluate(({ naturalWidth }) => naturalWidth > 0),
          "the picture",
        );
      },
      end: async () => {
        await page.getByRole("dialog").getByRole("button", { name: "Close" }).click();
        await card.getByRole("button", { name: "Close", exact: true }).click();
        await card.waitFor({ state: "detached" });
      },
    },
    {
      name: "kiosk: is anybody there?",
      start: async () => {
        await page.clock.fastForward((kIdle_s + 2) * 1000);
        await button("I am still here").waitFor();
      },
    },
    {
      name: "kiosk: the server is away",
      start: async () => {
        await pass_until(async () => (await begin.count()) > 0, "the tour to begin anew");
        const kept = () =>
          page.evaluate(
            async () =>
              (await (await caches.open("strata-kiosk")).keys()).filter(({ url }) =>
                new URL(url).pathname.endsWith("/picture"),
              ).length,
          );
        await pass_until(async () => (await kept()) === 3, "the pictures to be kept");
        await page.evaluate(() => navigator.serviceWorker.ready);
        await begin.click();
        await button("Next").waitFor();
        await server.signal("SIGTERM");
        await pass_until(
          () => page.getByText("Only still pictures at the moment").isVisible(),
          "the sign",
        );
      },
      end: async () => {
        await server.start();
        await pass_until(
          async () => (await page.locator("strata-kiosk-stage canvas.live").count()) > 0,
          "live pictures",
        );
      },
    },
    {
      name: "kiosk: its link was revoked",
      start: async () => {
        await server.request("DELETE", `/kiosks/${kiosk.id}`);
        await pass_until(
          () => heading("This screen no longer has a tour").isVisible(),
          "the end of it",
        );
      },
    },
  ];
}
