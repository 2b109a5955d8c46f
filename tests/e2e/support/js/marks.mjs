// A layer of records that can have lines and points.

/**
 * Creates the layer `Samples` of a table with one record, and returns a function that reads the lines
 * (`cracks`) or points (`places`) of this record.
 */
export async function with_samples(server, model) {
  const { project } = await server.json("GET", model);
  const columns = [
    { name: "Cracks", kind: "line" },
    { name: "Places", kind: "point" },
  ];
  await server.json("POST", `/projects/${project}/tables`, { name: "Samples", columns });
  await server.json("POST", "/tables/samples/records", { values: {} });
  await server.json("POST", `${model}/layers`, {
    name: "Samples",
    kind: "database",
    table: "samples",
    type: "u16",
    resolution: 2048,
  });
  return async (column) =>
    (await server.json("GET", "/tables/samples/records/1")).values[column] ?? [];
}
