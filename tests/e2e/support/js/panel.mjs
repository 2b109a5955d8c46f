// The side panel of a model's page.

/** Opens the tab of the side panel with this title, and the panel itself if it is hidden. */
export async function open_tab(page, w, title) {
  const show = page.getByRole("button", { name: w.model.show_panel, exact: true });
  if (await show.isVisible()) await show.click();
  await page.getByRole("tab", { name: title }).click();
}

/** Opens the controls of light (`w.view.light`) or section next to the bar over the 3D view. */
export async function open_on_picture(page, w, title) {
  const button = page
    .getByRole("toolbar", { name: w.picture_bar.title, exact: true })
    .getByRole("button", { name: title, exact: true });
  if ((await button.getAttribute("aria-expanded")) === "false") await button.click();
}
