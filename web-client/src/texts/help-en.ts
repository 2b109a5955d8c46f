// The rows of the help: keys and gestures, with their effects. They are loaded with the help.

export const help = {
  key_names:
    "Ctrl · Shift · Enter · Escape · Backspace · Delete · Tab · Space · Arrows · Up · Down · Left · Right · Page · Home · End · F2",
  mouse: "Mouse",
  touch: "Touch",
  mouse_rows: [
    ["Left drag", "use the active tool"],
    ["Rest the pointer (Orbit, Pan)", "preview the record there; Escape closes it"],
    ["Click (Orbit, Pan)", "open the record there"],
    ["Right drag, or Space + left", "orbit"],
    ["Middle drag, or Shift + right", "pan"],
    ["Wheel", "zoom at the pointer"],
  ],
  touch_rows: [
    ["One finger", "use the active tool"],
    ["Tap (Orbit, Pan)", "open the record there"],
    ["Two fingers", "drag to pan, pinch to zoom, twist to rotate"],
    ["Tap with Measure", "set a point; drag to orbit"],
    ["Pen", "use the active tool; your hand and fingers are ignored while the pen is near"],
    ["One finger after using a pen", "orbit, even with a paint or drawing tool"],
  ],
  tool_keys: "While a tool is active",
  tool_rows: [
    ["Enter · Backspace · Escape", "finish the polygon or line · remove the last corner · cancel"],
    [
      "Shift + A",
      "snap the polygon or line to edges and cracks, or stop snapping; each click fixes the previewed path",
    ],
    [
      "Shift + L, then strokes",
      "select an area by strokes inside it and, with Alt, outside of it; Shift + L: other side; Ctrl + Z: undo a stroke; Enter: accept the area",
    ],
    [
      "Polygon, lasso or wand with Shift · Alt",
      "add to the selection · subtract from it; both: intersect; Backspace removes the last part, Enter fills, Escape discards",
    ],
    ["C, then click", "comment on that point; Enter: on the middle of the view"],
    ["Ctrl + Enter · Escape", "send the comment · close it and keep the draft"],
    [
      "M, then click",
      "measure lengths, areas and profiles; M again: a point in the middle; Enter finishes, Escape clears",
    ],
    ["I, then click", "on a layer with records: open the record there and paint with it"],
  ],
  table: "In the table of records",
  table_rows: [
    ["Arrows · Page · Home · End", "move between cells; with Ctrl: first, last"],
    ["Enter, F2, or click again", "edit the cell; on the key: open the record's form"],
    [
      "Letters and digits",
      "type into text cells; digits also into number, date and time cells; in other cells, and after Escape in all cells, use shortcuts of the page such as T, D and V",
    ],
    [
      "Funnel of a column",
      "filter by values, a range, a text, or missing values; the filter field shows the condition",
    ],
    ["Enter · Tab · Escape", "while editing: down · next cell · cancel; Shift + Enter: new line"],
    ["Delete", "empty the cell"],
    ["Space, or click a key", "select the row; with Ctrl: more, with Shift: a range"],
    ["Ctrl + Z · Ctrl + Shift + Z", "undo · redo your table changes"],
    [
      "A column's ⋯ → Change",
      "rename it, also in other languages; each user sees the name in the language of their browser",
    ],
    ["Drop a CSV file", "preview the changes, then import them; term lists also accept SKOS"],
  ],
  brush: "Brush options",
  brush_rows: [
    [
      "Shape",
      "round, square, or a picture: choose + or drop a PNG or JPEG next to the shapes; everyone on the site can use them",
    ],
    [
      "Skip surfaces tilted more than",
      "skips surfaces that you see at a low angle; orbit to paint them",
    ],
    ["Paint through to the back", "also paints hidden surfaces"],
  ],
  terms: "In a term list",
  terms_rows: [
    ["Type", "find terms by name, in all languages"],
    ["Up · Down · Page", "move between terms"],
    ["Right · Left", "expand · collapse"],
    ["Enter", "paint with the term"],
    ["Escape", "show the whole list; again: back to the model"],
  ],
  layers: "Layers without a brush",
  layer_rows: [
    [
      "Layers ⋯ → From a template",
      "term lists, tables and layers for stone, wall painting, excavation and treatment",
    ],
    [
      "Layers ⋯ → Import a term list",
      "CSV or SKOS (Turtle, RDF/XML) with a preview; update and export a list from its table's ⋯",
    ],
    [
      "A layer's ⋯ → Paint from a file",
      "measured values, maps, shapefiles, GeoTIFF and scanned maps; numbers for the vertices of the scan",
    ],
    ["View → Surface images → Add an orthophoto", "project a picture onto the surface"],
    [
      "A layer's ⋯ → Areas",
      "areas of classes; for measurements a histogram that sets the color range",
    ],
    [
      "New layer → From an expression",
      "values computed from other layers, their records and the surface",
    ],
    [
      "New layer → From the shape",
      "values computed from the mesh, such as curvature, slope or distances",
    ],
    [
      "Layers ⋯ → Transfer layers",
      "transfer paint from an earlier scan of the object, with a report of losses",
    ],
    [
      "View → Tours",
      "saved views with texts in several languages, for a screen in an exhibition; kiosk links in a tour's ⋯",
    ],
    [
      "View → Billing",
      "positions that count areas, lengths and records by rules; Up · Down move, Right · Left open and close groups, Enter edits, Insert adds, Delete removes",
    ],
    [
      "Parts, over the 3D view",
      "show and hide the scans of a model that was imported from several ones",
    ],
  ],
};
