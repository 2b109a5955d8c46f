import { describe, expect, it } from "vitest";
import { PictureImport } from "../../../src/features/photographs/picture-import";
import { ApiError, cancelled } from "../../../src/net/api-error";
import { fakeApi } from "../../fake-api";

const file = (name: string): File => new File(["x"], name, { type: "image/jpeg" });
const flush = (): Promise<void> => new Promise((done) => setTimeout(done));

class Server {
  readonly sent: unknown[] = [];
  readonly waiting: { answer: () => void; fail: (error: Error) => void }[] = [];
  readonly pictures = new PictureImport(
    fakeApi({
      "POST /models/{model}/photographs": ({ query, signal }) => {
        this.sent.push(query.filename);
        return new Promise((answer, fail) => {
          signal?.addEventListener("abort", () => fail(cancelled()));
          this.waiting.push({ answer: () => answer({}), fail });
        });
      },
    }),
    "pot",
    () => {},
  );
}

describe("images of photographs", () => {
  it("are sent one after another, and a refused one does not stop the others", async () => {
    const { sent, waiting, pictures } = new Server();
    const stored = pictures.send(["a.jpg", "b.jpg", "c.jpg"].map(file));
    await flush();
    expect([sent, pictures.isRunning, pictures.total]).toEqual([["a.jpg"], true, 3]);
    waiting[0]!.answer();
    await flush();
    expect([sent, pictures.done]).toEqual([["a.jpg", "b.jpg"], 1]);
    waiting[1]!.fail(
      new ApiError({ title: "Unknown name", detail: "No photograph.", status: 422 }),
    );
    await flush();
    waiting[2]!.answer();
    expect(await stored).toBe(2);
    expect([pictures.done, pictures.isRunning]).toEqual([3, false]);
    expect(pictures.refused).toEqual([{ name: "b.jpg", reason: "No photograph." }]);
  });

  it("can be stopped, without a reason for the rest", async () => {
    const { sent, waiting, pictures } = new Server();
    const stored = pictures.send(["a.jpg", "b.jpg", "c.jpg"].map(file));
    await flush();
    waiting[0]!.answer();
    await flush();
    pictures.stop();
    expect(await stored).toBe(1);
    expect([sent.length, pictures.isRunning, pictures.refused]).toEqual([2, false, []]);
  });
});
