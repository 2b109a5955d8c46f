// The demo pot with one layer for painting.
import { rgb } from "./browser.mjs";

/**
 * Hides the layers of the demo pot and creates the layer `Finds`. Returns the model, the path of the
 * layer and the color of its only class, *Bone*.
 */
export async function with_one_layer(server, color) {
  const model = (await server.json("GET", "/models")).models[0];
  const layers = `/models/${model.id}/layers`;
  for (const other of (await server.json("GET", layers)).layers)
    await server.json("PATCH", `${layers}/${other.id}`, { visible: false });
  const palette = { mode: "categorical", points: [{ at: 1, color, label: "Bone" }] };
  await server.json("POST", layers, { name: "Finds", type: "u8", palette });
  return { model, finds: `${layers}/finds`, bone: rgb(color) };
}
