// The messages that a page stores in the browser until they are saved.

/**
 * Returns the ids of the stroke batches, or of other messages, that the browser stores, in their
 * order.
 */
export const unsaved_ids = (page, wanted = "stroke.extend") =>
  page.evaluate(
    (wanted) =>
      new Promise((done, failed) => {
        const request = indexedDB.open("strata");
        request.onerror = () => failed(request.error);
        request.onsuccess = () => {
          const database = request.result;
          const all = database.transaction("unsaved").objectStore("unsaved").getAll();
          all.onsuccess = () => (
            database.close(),
            done(all.result.filter(({ op }) => op === wanted).map(({ id }) => id))
          );
        };
      }),
    wanted,
  );
