// Additions to the contract's schemas for making requests: the objects on the site, the syntax of
// conditions and cells, and the requirements of operations.
import { fc, strange_text } from "./arbitraries.mjs";
import { kColumnSlugs, kLayers } from "./site.mjs";

const kPassword = "seven blue herons at noon";
/** In a path, an object that is made only for this request. */
export const kSpare = "(a spare one)";

export const one = (...values) => fc.constantFrom(...values);
export const mostly = (...values) =>
  fc.oneof(
    { weight: 12, arbitrary: one(...values) },
    { weight: 1, arbitrary: one("nothing", "999999", "0") },
  );

const point = fc.tuple(
  fc.integer({ min: 0, max: 100 }),
  fc.integer({ min: 0, max: 100 }),
  one(0, 0.5, 20),
);
const pixel = fc.tuple(fc.integer({ min: 0, max: 160 }), fc.integer({ min: 0, max: 120 }));
/** An orthographic camera perpendicular to the wall, 160 × 120 mm. */
const camera = fc
  .record({ x: fc.integer({ min: 30, max: 70 }), width: one(160, 320), section: fc.boolean() })
  .map(({ x, width, section }) => ({
    view: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -50, -200, 1],
    projection: [1 / 80, 0, 0, 0, 0, 1 / 60, 0, 0, 0, 0, -0.01, 0, 0, 0, -2, 1],
    width,
    height: (width * 3) / 4,
    ...(section ? { section: [[1, 0, 0, -x / 2]] } : {}),
  }));
const layer = fc.oneof(mostly(...kLayers), one(1, 2));
const condition = one(
  "cracks > 1",
  "x < 12 and y < 12",
  "moisture > 0.3 and not valid(cracks)",
  "units.depth > 0.5",
  "units.state = 'loose'",
  "units in (1, 2)",
  "true",
  "false",
);
const filter = one(
  "depth > 0.5",
  "state = 'loose' and depth between 0 and 9",
  "code like 'SU%'",
  "period < '1600'",
  "damage.code = 'loss'",
  "a_contains(above, (1))",
  "found is null",
  "key > 1",
);
const at = one(1, 2, 3, "2030-01-01T00:00:00Z", "2001-05-04T12:00:00Z", 999999);
const cells = fc.record(
  {
    code: fc.uuid(),
    depth: one(0.5, 3, null),
    layers: one(1, 2),
    period: one("156X", "-0043/0100"),
    state: one("loose", "firm"),
    found: one("2024-02-29", null),
    damage: one(1, 2),
    above: one([], [1], [1, 2]),
    wet: fc.boolean(),
  },
  { requiredKeys: ["code"] },
);
const palette = one(
  {
    mode: "linear",
    min: 0,
    max: 1,
    points: [
      { at: 0, color: "#440154" },
      { at: 1, color: "#fde725ff" },
    ],
  },
  {
    mode: "categorical",
    points: [{ at: 3, color: "#d55e00", label: "Crack", pattern: "hatch", angle: 30 }],
  },
  {
    mode: "step",
    points: [
      { at: 0, color: "#fff5f0" },
      { at: 2, color: "#de2c26" },
    ],
  },
  { mode: "categorical", column: "state", points: [{ at: 0, value: "loose", color: "#d55e00" }] },
);

const by_schema = {
  Camera: camera,
  Point3: point,
  Point2: pixel,
  LayerRef: layer,
  TableRef: mostly("units", "damage", "scratch"),
  ToolShape: mostly("disc", "square", "leaf"),
  Palette: palette,
  At: at,
  CellValues: cells,
  // the lowest resolution; higher ones use the same code but need more time
  Resolution: one(2048),
};
export const words = {
  by_schema,
  by_name: {
    where: condition,
    filter,
    expression: one("moisture * 2", "if(units.state = 'loose', 1, 0)", "z + cracks", "cracks >"),
    value: one(0, 1, 2, 3, 0.5),
    model: mostly("wall", "wall-2"),
    from: mostly("wall", "wall-2"),
    radius_mm: one(2, 8),
    radius_px: one(3, 12.5),
    step_mm: one(1, 10),
    tolerance_mm: one(1),
    distance_mm: one(50),
    look: mostly("infrared"),
    property: mostly("quality"),
    rays: one(16),
    order: one(-1, 0, 7),
    // true would make all other changes fail (428); versions_test.py tests it
    require_if_match: one(false),
    language: mostly("es", "en"),
  },
};

export const path_words = {
  project: mostly("site", "default"),
  provider: mostly("museum"),
  model: mostly("wall", "wall", "wall-2"),
  layer: mostly(...kLayers),
  look: mostly("infrared", "1"),
  photograph: mostly("1"),
  collection: mostly("wall", "wall.cracks", "wall.units", "wall.units.code", "wall.nothing"),
  feature: mostly("1", "1-1", "range-1"),
  annotation: mostly("areas.1", "areas.2"),
  plane: mostly("xy", "xz"),
  view: mostly("west", "1"),
  tour: mostly("round", "1"),
  snapshot: mostly("first", "1"),
  selection: mostly("sunny", "1"),
  object: mostly("1"),
  bill: mostly("1"),
  kiosk: mostly("1"),
  file: mostly("1"),
  entry: mostly("layer-1", "model-1", "record-1-1"),
  tool: mostly("leaf", "1"),
  table: mostly("units", "damage", "scratch"),
  column: mostly(...kColumnSlugs),
  key: mostly("1", "2", "3"),
  attachment: mostly("1", "2"),
  comment: mostly("1", "1", "2"),
  job: mostly("(a job)"),
  name: mostly("wall.ply"),
  format: one("png", "npy", "tif"),
  template: mostly("stone-condition", "excavation-units"),
  user: mostly("guest", "Vera"),
  group: mostly("1"),
  session: mostly("1"),
  token: mostly("1"),
};
export const query_words = {
  at: at.map(String),
  since: one("2001-05-04T12:00:00Z", "2030-01-01", "yesterday"),
  filter,
  where: condition,
  sortby: one("depth", "-code", "key", "area_m2", "depth,-code", "nothing"),
  project: mostly("site"),
  coords: one("POINT Z(50 50 1)", "POINT(10 10 0)", "POINT Z(1 2"),
  bbox: one("0,0,0.05,0.05", "0,0,0,0.05,0.05,1", "0.05,0,0,1"),
  "bbox-crs": one("http://www.opengis.net/def/crs/OGC/1.3/CRS84", "EPSG:25830"),
  datetime: one("2030-01-01T00:00:00Z", "2001-05-04T12:00:00Z/..", "../2030-01-01", "yesterday"),
  subset: one("x(0:0.05)", "x(0.01:*),y(0:0.05)", "x(1)"),
  "scale-factor": one("2", "64", "-1"),
  "scale-axes": one("x(2),y(4)", "q(1)"),
  "scale-size": one("x(20),y(10)", "x(0)"),
  width: one("20"),
  height: one("10"),
  offset: one("0", "1"),
  columns: one("code", "code,depth"),
  "parameter-name": one("cracks", "cracks,units", "nothing"),
  layers: one("cracks", "moisture,units", "nothing"),
  include: one("pieces", "quantiles", "pieces,quantiles", "all"),
  cell: one("5mm", "2cm", "5"),
  world: one("4,0,0,-4,2,90", "1,0,0,0,0"),
  column: mostly("photos", "papers", "code"),
  q: one("loss", "perd", ""),
  radius_mm: one("4"),
  tolerance_mm: one("3"),
  crs: one("EPSG:25830"),
  filename: one("wall.ply", "scan.obj"),
  weld: one("0", "0.001"),
  along: one("-z", "+z", "+x"),
  colors: one('{"#c81e1e": 1}', "auto", "red"),
  band: one("1"),
  source: one("wall.ply"),
  attribute: one("zone", "nothing"),
  names: one("zone"),
  link: one("(the owner's link)", "3q2-7wAAqrs"),
  from: one("2001-05-04T12:00:00Z", "2030-01-01", "yesterday"),
  to: one("2", "3", "2030-01-01T00:00:00Z"),
};

const file = (...names) => one(...names.map((name) => ({ file: name })));
export const content_of = {
  "application/octet-stream": file("letter.txt", "picture.png", "wall.ply", "noise.bin"),
  "application/zip": file("empty.zip", "noise.bin"),
  "image/png": file("picture.png"),
  "image/jpeg": file("noise.bin", "picture.png"),
  "image/tiff": file("noise.bin"),
  "image/webp": file("noise.bin", "picture.png"),
  "image/bmp": file("noise.bin"),
  "image/x-tga": file("noise.bin"),
  "application/x-npy": file("noise.bin"),
  "text/csv": file("terms.csv"),
  "text/turtle": file("terms.ttl"),
  "application/rdf+xml": file("terms.rdf"),
  "application/geo+json": file("map.geojson"),
  "application/xml": file("tender.x83"),
  "multipart/form-data": file("map.geojson", "picture.png", "letter.txt", "wall.ply"),
};

const spare = (name, ...others) => ({ [name]: one(kSpare, kSpare, kSpare, ...others, "nothing") });
const json = (schema_words) => ({
  words: {
    by_schema: { ...by_schema, ...schema_words.by_schema },
    by_name: { ...words.by_name, ...schema_words.by_name },
  },
});
const world = "4,0,0,-4,2,90"; // for the picture of 24 × 16 pixels
const scratch = { path: { table: one("scratch") } };
const of_photograph = { path: { model: one("wall"), photograph: mostly("1") } };
const units_layer = {
  path: { model: one("wall"), layer: one("units", "units", "units", "cracks") },
};
const new_record = fc.record({ values: cells });
const new_records = {
  ...json({
    by_schema: {
      RecordsCreate: fc.oneof(
        new_record,
        fc.record({ records: fc.array(new_record, { minLength: 1, maxLength: 3 }) }),
        fc.record({ key: fc.integer({ min: 1, max: 2 ** 31 }), values: cells }),
      ),
    },
  }),
  content: { "text/csv": file("records.csv", "records.csv", "terms.csv") },
};
const form_of = (...names) => ({ "multipart/form-data": file(...names) });
const attach = { content: { "application/octet-stream": file("letter.txt", "picture.png") } };

const tour_stop = fc.record(
  {
    view: mostly("west", "1"),
    title: fc.oneof(
      { weight: 12, arbitrary: one({ en: "Here", es: "Aquí" }) },
      { weight: 1, arbitrary: one({ fr: "Ici" }) },
    ),
    text: one({}, { en: "Broken\nin 2019." }),
    layers: one([], ["cracks"], ["cracks", "moisture"], ["moisture", "units"]),
    records: one(
      [],
      [{ table: "units", keys: [1, 2], columns: [{ column: "code", labels: { es: "Código" } }] }],
    ),
    transition: one("cut", "move"),
  },
  { requiredKeys: ["view", "title"] },
);
const tour = {
  path: { model: one("wall", "wall", "wall", "nothing") },
  ...json({
    by_name: {
      languages: one(["en", "es"], ["es", "en"]),
      stops: fc.array(tour_stop, { minLength: 1, maxLength: 2 }),
    },
  }),
};

const what_of_texels = one({}, { texels: "clear" }, { texels: "reassign", to: "2" });

/**
 * Requirements of operations that are neither in their schema nor above. Requests that delete an
 * object use a spare one. Requests that change names or storage use objects that other requests do
 * not need.
 */
export const particulars = {
  login: json({ by_name: { token: fc.oneof(one("(the owner's token)"), strange_text) } }),
  change_password: json({
    by_schema: {
      PasswordChange: one({ password: "short" }, { current: kPassword, password: "short" }),
    },
  }),
  end_session: { path: spare("session") },
  revoke_token: { path: spare("token") },
  get_user: { path: { user: mostly("guest", "VERA", "owner") } },
  change_user: { path: spare("user", "guest") },
  delete_user: { path: spare("user", "owner") },
  invite_again: { path: spare("user", "owner") },
  show_invitation: json({
    by_name: { invitation: one("(an invitation)", "(an invitation)", "guess") },
  }),
  accept_invitation: json({
    by_name: {
      invitation: one("(an invitation to accept)", "guess"),
      password: one(kPassword, "short"),
    },
  }),
  invite_user: json({ by_name: { groups: one([1], [1], [987654321]) } }),
  create_group: json({ by_name: { members: one(["guest"], [], ["guest", "VERA"], ["nobody"]) } }),
  change_group: {
    path: spare("group", "1"),
    ...json({
      by_name: {
        name: fc.uuid(),
        add: one(["guest"], ["Vera"], ["nobody"]),
        remove: one(["guest"], ["vera"]),
      },
    }),
  },
  delete_group: { path: spare("group") },
  remove_project_group: { path: { project: mostly("site"), ...spare("group", "1") } },
  delete_project: { path: spare("project", "site") },
  delete_model: { path: spare("model") },
  delete_layer: { path: { model: one("wall"), ...spare("layer") } },
  delete_look: { path: { model: one("wall-2"), ...spare("look") } },
  create_look: { path: { model: one("wall") } },
  import_photograph_poses: {
    content: { "application/octet-stream": file("poses.csv", "poses.csv", "noise.bin") },
  },
  add_photograph_picture: {
    path: { model: one("wall") },
    queries: one({ filename: "site/Picture.png" }, { filename: "other.png" }),
    content: { "image/png": file("picture.png") },
  },
  get_photograph: of_photograph,
  get_ogc_items: { path: { collection: mostly("wall.units", "wall.cracks") } },
  get_ogc_item: { path: { collection: mostly("wall.units"), feature: mostly("1", "2") } },
  get_ogc_coverage: { path: { collection: mostly("wall.moisture", "wall.cracks") } },
  get_ogc_position: {
    path: { collection: mostly("wall") },
    query: { coords: one("POINT(0.02 0.02)", "POINT Z(0.02 0.02 0)", "POINT(1") },
  },
  get_ogc_trajectory: {
    path: { collection: mostly("wall") },
    query: { coords: one("LINESTRING(0.01 0.01, 0.03 0.03)", "POINT(1 2)") },
  },
  get_ogc_area: {
    path: { collection: mostly("wall") },
    query: { coords: one("POLYGON((0.01 0.01, 0.03 0.01, 0.03 0.03, 0.01 0.01))", "POLYGON(1)") },
  },
  get_layer_annotation: {
    path: { model: one("wall"), layer: one("units"), annotation: one("areas.1", "areas.2", "no") },
  },
  get_photograph_picture: of_photograph,
  get_undistorted_photograph: of_photograph,
  set_photograph_picture: {
    ...of_photograph,
    content: { "image/png": file("picture.png", "picture.png", "noise.bin") },
  },
  delete_photograph: { path: { model: one("wall"), ...spare("photograph") } },
  delete_photographs: { path: { model: one("wall-2") } },
  delete_tool: { path: spare("tool") },
  delete_table: { path: spare("table", "units") },
  delete_record: { path: { table: one("units"), ...spare("key", "1") }, queries: what_of_texels },
  delete_layer_record: {
    path: { model: one("wall"), layer: one("units"), ...spare("key", "1") },
    queries: what_of_texels,
  },
  delete_attachment: { path: spare("attachment") },
  delete_comment: { path: spare("comment") },
  login_kiosk: json({
    by_name: { link: fc.oneof(one("(a kiosk's link)"), one("(a kiosk's link)"), strange_text) },
  }),
  create_tour: tour,
  change_tour: { ...tour, path: { model: one("wall"), tour: mostly("round", "1") } },
  restore_from_bin: { path: { project: one("site"), ...spare("entry") } },
  erase_from_bin: { path: { project: one("site"), ...spare("entry") } },
  delete_tour: { path: { model: one("wall"), ...spare("tour") } },
  create_tour_file: {
    path: { model: one("wall"), tour: mostly("round") },
    content: { "application/octet-stream": file("letter.txt", "picture.png") },
  },
  get_tour_file: { path: { model: one("wall"), tour: one("round"), file: mostly("1") } },
  create_kiosk: { path: { model: one("wall"), tour: mostly("round") } },
  reload_kiosk: { path: spare("kiosk", "1") },
  revoke_kiosk: { path: spare("kiosk") },
  delete_view: { path: { model: one("wall"), ...spare("view") } },
  delete_snapshot: { path: { model: one("wall"), ...spare("snapshot") } },
  delete_selection: { path: { model: one("wall"), ...spare("selection") } },
  change_selection: { path: { model: one("wall"), ...spare("selection") } },
  delete_bill: { path: { project: one("site"), ...spare("bill") } },
  replace_bill: { path: { project: one("site"), ...spare("bill", "1") } },
  import_bill: {
    path: { project: one("site") },
    content: { "application/octet-stream": file("tender.x83", "letter.txt") },
  },
  delete_object: { path: { project: one("site"), ...spare("object", "1") } },
  // The metadata of `site` stay complete, for make_deposit.
  replace_metadata: {
    path: { project: mostly("default") },
    ...json({
      by_schema: {
        MetadataLanguage: one("en", "de-AT"),
        MetadataUri: one("https://example.org/x", "urn:x"),
        DepositRights: one({ license: "CC-BY-4.0" }, { text: "Ask us" }, { license: "none" }),
        DepositDate: one({ date: "2024-05", kind: "created" }, { date: "soon", kind: "other" }),
        DepositRelated: one({ identifier: "10.1000/182", kind: "doi", relation: "cites" }),
      },
      by_name: {
        doi: one("10.5281/zenodo.1", "none at all"),
        orcid: one("0000-0002-1825-0097", "0000-0002-1825-0098"),
        ror: one("https://ror.org/04wxnsj81"),
      },
    }),
  },
  make_deposit: { path: { project: mostly("site") } },
  set_photograph_rights: {
    path: { model: mostly("wall") },
    ...json({ by_name: { rights_uri: one("CC-BY-4.0", ""), photographs: one([1]) } }),
  },
  change_snapshot: { path: { model: one("wall"), ...spare("snapshot") } },
  change_view: { path: { model: one("wall"), ...spare("view", "west") } },
  change_comment: { path: spare("comment", "2") },
  create_comment: {
    path: { model: one("wall", "wall", "wall", "nothing") },
    ...json({
      by_schema: {
        CommentCreate: fc
          .tuple(
            point,
            one(
              {},
              { layer: "cracks" },
              { layer: "units", record: 1 },
              { layer: "cracks", record: 1 },
            ),
          )
          .map(([position, about]) => ({
            text: "Since when?\nSee https://example.org, @guest",
            position,
            ...about,
          })),
      },
    }),
  },
  drop_column: { path: { table: one("scratch"), ...spare("column") } },
  change_column: {
    path: { table: one("scratch"), ...spare("column", "note") },
    ...json({ by_name: { target: one("units", "scratch") } }),
  },
  cancel_job: { path: spare("job", "(a job)") },
  get_job_file: { path: { job: mostly("(a figure's job)", "(a figure's job)", "(a job)") } },
  make_figure: {
    path: { model: one("wall") },
    // small figures; larger ones use the same code but need more time
    ...json({
      by_name: {
        dpi: one(50, 60, 20),
        view: one("west", "nothing"),
        scale: one(0.5, 1, 20, 0),
        normal: one([0, 0, 1], [0, -1, 1], [0, 0, 0]),
      },
      by_schema: {
        FigureLabels: one(
          { layer: "units", column: "code" },
          { layer: "cracks", column: "code" },
          { layer: "units", column: "nothing" },
        ),
        FigureRollout: one(
          { axis: { point: [0, 0, -1], direction: [0, 1, 0] } },
          { axis: { point: [0, 0, -1], direction: [0, 1, 0] }, radius: 1, cut: 90, relief: false },
          { radius: 1 },
        ),
      },
    }),
  },
  export_model: {
    path: { model: one("wall") },
    // small textures; larger ones use the same code but need more time
    ...json({
      by_name: {
        texture_size: one(512, 600, 100),
        features: one("cracks", "units", "nothing"),
      },
    }),
  },
  make_report: {
    path: { model: one("wall") },
    // few drawings, as each takes a second
    ...json({
      by_name: {
        figures: one([], [{ direction: "top", scale: 20 }], [{ view: "west" }], [{}]),
        record_pictures: one(false, false, 1),
        max_records: one(0, 1, -1),
        logo: one("", "bm8="),
      },
    }),
  },
  rollout: {
    path: { model: one("wall") },
    ...json({
      by_name: {
        mm_per_pixel: one(20, 50, 50, 0),
        radius: one(0.5, 2, 2, 0),
        half_angle: one(0, 20, -5),
        // most other values are unknown layers and images
        layers: one([], [{ layer: "cracks", visible: true }], [{ layer: "nothing" }]),
        looks: one([], []),
      },
      by_schema: {
        RolloutAxis: one(
          { point: [0, 0, -1], direction: [0, 1, 0] },
          { point: [0, 0, -1], direction: [0, 1, 0] },
          { point: [0, 0, 0], direction: [0, 0, 0] },
        ),
      },
    }),
  },
  change_model: { path: { model: one("wall-2") } },
  change_project: { path: { project: one("site", "default") } },
  change_layer: { path: { model: one("wall"), ...spare("layer") } },
  add_orthophoto: {
    queries: one({ name: "Orthophoto", world }),
    content: { "image/jpeg": file("picture.png"), ...form_of("picture.png") },
  },
  import_model: {
    content: { "application/octet-stream": file("wall.ply", "wall.ply", "noise.bin") },
  },
  create_table: json({ by_schema: { TableRef: one("damage") } }),
  change_table: scratch,
  undo_table: scratch,
  redo: { path: { model: one("wall-2"), layer: one("undone", "cracks") } },
  list_review: {
    path: { model: one("wall-2"), layer: one("reviewed", "reviewed", "cracks") },
    queries: one({}, { user: "rita" }),
  },
  review_edits: {
    path: { model: one("wall-2"), layer: one("reviewed", "reviewed", "reviewed", "cracks") },
    ...json({
      by_schema: {
        Review: one(
          { decision: "accept", user: "rita" },
          { decision: "reject", all: true, reason: "Not a crack" },
          { decision: "accept", user: "nobody" },
          { decision: "reopen", edits: [1] },
        ),
      },
    }),
  },
  redo_table: { path: { table: one("undone", "scratch") } },
  compute_layer: { path: { model: one("wall"), layer: one("risk", "risk", "cracks") } },
  clean_up_layer: {
    path: { model: one("wall"), layer: one("cracks", "cracks", "units", "risk") },
    ...json({
      by_schema: {
        Cleanup: one(
          { operation: "sieve", area_cm2: 0.5, apply: false },
          { operation: "sieve", area_cm2: 0.1, erase_regions: true },
          { operation: "fill-holes", area_cm2: 0.5 },
          { operation: "majority", radius_mm: 1 },
          { operation: "border", width_mm: 1, of: 3, value: 1 },
          { operation: "border", width_mm: 1, from: "units", erase: true },
          { operation: "border", width_mm: 1 },
        ),
      },
    }),
  },
  compare_layer: {
    path: { model: one("wall"), layer: one("cracks", "units", "moisture") },
    ...json({
      by_schema: {
        LayerChangesRequest: one(
          { since: "wall-2", tolerance_mm: 1 },
          { since: "wall-2", layer: "cracks", tolerance_mm: 5, max_angle: 90, min_area_cm2: 1 },
          { since: "wall", tolerance_mm: 1 },
        ),
      },
    }),
  },
  create_piece_records: {
    path: { model: one("wall"), layer: one("cracks", "cracks", "units") },
    ...json({
      by_schema: {
        PieceRecords: one(
          { into: "units", apply: false },
          { into: "units", of: 3, min_area_cm2: 1 },
          { into: "cracks" },
          { into: "units", area_column: "nothing" },
        ),
      },
    }),
  },
  transfer_layers: {
    path: { model: one("wall-2") },
    ...json({ by_name: { layers: one(["cracks"], ["moisture"], ["cracks", "units"]) } }),
  },
  import_vertex_values: {
    path: { model: one("wall"), layer: one("cracks", "cracks", "moisture", "moisture", "risk") },
    content: { "text/csv": file("vertices.csv", "vertices.csv", "readings.csv") },
  },
  paint_readings: {
    path: { model: one("wall"), layer: one("cracks", "cracks", "moisture", "moisture", "risk") },
    content: { "text/csv": file("readings.csv") },
  },
  paint_polygons: {
    path: { model: one("wall"), layer: one("cracks", "cracks", "moisture", "moisture", "risk") },
    queries: one(
      { value: "1" },
      { attribute: "zone" },
      { attribute: "zone", names: "zone", along: "+z" },
    ),
    content: form_of("map.geojson"),
  },
  paint_picture: {
    path: { model: one("wall"), layer: one("cracks", "cracks", "moisture", "moisture", "risk") },
    content: { "image/jpeg": file("picture.png"), ...form_of("picture.png") },
    queries: one(
      { world },
      { world, colors: "auto" },
      { world, along: "+z", tolerance: "20", colors: '{"#c81e1e": 1}' },
    ),
  },
  put_texels: {
    path: { model: one("wall"), layer: one("cracks"), format: one("png", "png", "npy") },
    content: {
      "image/png": file("cracks.png"),
      "application/x-npy": file("cracks.npy"),
      "image/tiff": file("cracks.png"),
    },
  },
  get_texel_lines: { path: units_layer.path },
  use_template: {
    path: { project: one(kSpare, kSpare, "site", "nothing") },
    ...json({
      by_schema: {
        TemplateUse: one({}, { language: "es" }, { language: "pt-BR" }, { model: "wall" }),
      },
    }),
  },
  create_records: { path: { table: mostly("units") }, ...new_records },
  import_terms: { path: { table: one("damage", "damage", "damage", "units") } },
  list_terms: { path: { table: one("damage", "damage", "damage", "units") } },
  list_cycles: { path: { table: one("units"), column: one("above", "above", "code") } },
  list_classes: { path: { table: one("units") } },
  match_attachments: {
    path: { table: one("units") },
    ...json({
      by_name: {
        pattern: one("{code}_{view}_{n}.jpg", "{code}.png", "{key}-{n}.png", "plain"),
        column: one("code", "key"),
        names: one(["SU 1_north_1.jpg", "SU 9_x_2.jpg"], ["2-1.png"]),
      },
    }),
  },
  record_extent: units_layer,
  get_timeline: {
    queries: one(
      {},
      { intervals: "7" },
      { from: "2020-01-01T00:00:00Z", to: "2090-01-01T00:00:00Z" },
    ),
  },
  list_undo_steps: { queries: one({}, { limit: "3" }) },
  list_timeline_steps: { queries: one({}, { before: "4" }, { after: "2", limit: "3" }) },
  object_statistics: {
    query: {
      layer: mostly(...kLayers),
      from: one("2018", "2019-05", "2019-05-01", "2019-13"),
      to: one("2019", "2018-12", "2019-02-30"),
    },
  },
  layer_difference: json({ by_name: { from: one(0, 1, 3), to: one(0, 2) } }),
  list_layer_records: units_layer,
  create_layer_records: { ...units_layer, ...new_records },
  cross_table: json({
    by_name: { rows: mostly("cracks", "units"), columns: mostly("units", "cracks", "risk") },
  }),
  get_layer_record: units_layer,
  change_layer_record: units_layer,
  list_layer_attachments: units_layer,
  create_attachments: { path: { table: one("units") }, ...attach },
  create_layer_attachments: { ...units_layer, ...attach },
  create_column: { path: { table: one("scratch") } },
  change_record: { path: { table: mostly("units") } },
  create_layer: json({
    by_name: {
      columns: fc.array(fc.record({ name: one("Name", "Depth") }), { maxLength: 2 }),
      table: one("units", "damage"),
      expression: one("moisture * 2", "cracks + 1", "nothing + 1"),
    },
  }),
  preview_layer: {
    path: { model: one("wall") },
    // some kinds of computations take half a minute
    ...json({
      by_schema: {
        LayerCreate: fc.oneof(
          fc.record({
            name: fc.uuid(),
            resolution: one(2048),
            expression: one("moisture * 2", "distance(cracks, 0.1)", "nothing + 1"),
          }),
          fc.record({ name: fc.uuid(), compute: fc.record({ kind: one("height", "slope") }) }),
          fc.record({ name: fc.uuid() }),
        ),
      },
    }),
  },
  run_analysis: json({
    by_schema: {
      AnalysisStep: fc.oneof(
        fc.record({
          layer: fc.record({
            name: fc.uuid(),
            resolution: one(2048),
            expression: one("moisture * 2", "cracks + 1", "nothing + 1"),
          }),
        }),
        fc.record({
          statistics: fc.record({ layer: one("cracks", "moisture", "nothing"), where: condition }),
        }),
      ),
    },
  }),
};

// Headers that a proxy or a script may add: folder names, tokens, tags.
export const header_words = {
  "If-Match": one('"v1"', "*", '"v999"', "v1", '""'),
  "Idempotency-Key": fc.oneof(fc.uuid(), one("the same", "k".repeat(255))),
  "If-None-Match": one('"v1"', '"v2"', "*"),
  "Last-Event-ID": one("1777896570120000-7", "yesterday"),
  Prefer: one("respond-async", "return=minimal"),
  "If-Range": one('"v1"'),
  Range: one("bytes=0-9", "bytes=5-", "bytes=-4", "bytes=999999-", "bytes=9-2", "lines=1"),
};
