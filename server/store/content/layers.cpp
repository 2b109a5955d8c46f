#include "store/content/layers.h"
#include "core/text/utf8.h"
#include "domain/layers/group_name.h"
#include "domain/layers/revision.h"
#include "domain/layers/tile_segment.h"
#include "domain/tables/term_list.h"
#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"
#include "store/tables/table_writer.h"

namespace strata::store {
namespace {

// True if an input of a computed layer is newer than the layer, or deleted.
constexpr auto kLayerStale = sql(
    "(expression IS NOT NULL AND (computed_sequence = 0 OR EXISTS (SELECT 1 FROM layer_inputs i LEFT JOIN layers l ON "
    "l.id = i.input_id LEFT JOIN record_tables t ON t.id = i.table_id WHERE i.layer_id = layers.id AND (l.id IS NULL OR "
    "l.sequence > layers.computed_sequence OR t.sequence > i.table_sequence))))");
constexpr auto kLayerColumns = sql(
    "id, model_id, name, slug::text, kind, type, resolution, unit, description, palette, opacity, visible, draw_order, "
    "table_id, sequence, version, locked, visibility, review, labels, descriptions, group_name, blend, "
    "(SELECT o.origin FROM layer_origins o WHERE o.layer_id = layers.id), "
    "coalesce((SELECT o.edited_by_hand FROM layer_origins o WHERE o.layer_id = layers.id), false), "
    "(SELECT o.analysis FROM layer_origins o WHERE o.layer_id = layers.id), "
    "expression, automatic, computed_sequence, "
    "EXISTS (SELECT 1 FROM layer_inputs i JOIN record_tables t ON t.id = i.table_id WHERE i.layer_id = layers.id AND "
    "t.sequence > i.table_sequence), ",
    kLayerStale,
    ", (SELECT coalesce(jsonb_agg(jsonb_build_object('slug', i.slug, 'layer', "
    "(SELECT l.id FROM layers l WHERE l.id = i.input_id), 'table', i.table_id) ORDER BY i.slug), '[]') "
    "FROM layer_inputs i WHERE i.layer_id = layers.id)");

// Replaces a palette without points by the palette of the terms, if the table of the layer is a
// term list.
Result<void> take_term_colors(PgConnection& connection, Layer& layer) {
  if (!layer.table || !takes_term_colors(layer.palette)) return {};
  auto palette = STRATA_TRY(term_palette_of(connection, *layer.table));
  layer.palette_of_terms = palette.has_value();
  if (layer.palette_of_terms) layer.palette = std::move(*palette);
  return {};
}

// Returns the palette as stored: a palette of terms has no points.
nlohmann::json palette_to_keep(const Layer& layer) {
  if (!layer.palette_of_terms) return to_json(layer.palette);
  return to_json(terms_palette({}));
}

LayerAnalysis analysis_of(const nlohmann::json& stored) {
  return {stored.at("name").get<std::string>(), stored.at("step").get<int>(),
          stored.at("of").get<int>(), stored.at("job").get<JobId>()};
}

template <class Id>
std::optional<Id> optional_id(const nlohmann::json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<Id>());
}

Result<Layer> read_layer(PgConnection& connection, const PgResult& rows, int i) {
  PgRow row(rows, i);
  Layer layer;
  layer.id = row.id<LayerId>();
  layer.model_id = row.id<ModelId>();
  layer.name = row.text();
  layer.slug = row.text();
  layer.kind = row.text() == "database" ? LayerKind::database : LayerKind::numeric;
  const auto type = parse_value_type(row.text());
  if (!type)
    return fail(ErrorCode::internal, "Damaged layer",
                "Layer " + to_string(layer.id) + " has an unknown value type.");
  layer.type = *type;
  layer.resolution = static_cast<int>(row.integer());
  layer.unit = row.text();
  layer.description = row.text();
  // A layer with a damaged palette is still shown, in default colors.
  layer.palette = palette_from_json(row.json())
                      .value_or(default_palette(layer.type, layer.kind == LayerKind::database));
  layer.opacity = row.real();
  layer.visible = row.boolean();
  layer.order = static_cast<int>(row.integer());
  layer.table = row.id<std::optional<TableId>>();
  STRATA_TRY(take_term_colors(connection, layer));
  layer.sequence = row.integer();
  layer.version = row.integer();
  layer.locked = row.boolean();
  // Replaces an unknown visibility by the most restricted one.
  layer.visibility = parse_visibility(row.text()).value_or(Visibility::curators);
  layer.review = row.boolean();
  layer.labels = row.json().get<Labels>();
  layer.descriptions = row.json().get<Labels>();
  layer.group = row.optional_text();
  layer.blend = parse_layer_blend(row.text()).value_or(LayerBlend::normal);
  if (const auto origin = row.optional_text())
    layer.origin = *origin == "shape" ? LayerOrigin::shape : LayerOrigin::expression;
  layer.edited_by_hand = row.boolean();
  if (const auto analysis = row.optional_json()) layer.analysis = analysis_of(*analysis);
  const auto expression = row.optional_text();
  if (!expression) return layer;
  LayerFormula formula;
  formula.expression = *expression;
  formula.automatic = row.boolean();
  formula.computed_sequence = row.integer();
  formula.records_changed = row.boolean();
  formula.stale = row.boolean();
  for (const nlohmann::json& input : row.json()) {
    formula.inputs.push_back({input.at("slug").get<std::string>(),
                              optional_id<LayerId>(input.at("layer")),
                              optional_id<TableId>(input.at("table"))});
  }
  layer.formula = std::move(formula);
  return layer;
}

Result<Layer> load_layer(PgConnection& connection, LayerId id) {
  auto row = STRATA_TRY(connection.query(
      sql("SELECT ", kLayerColumns, " FROM layers WHERE id = $1"), Params().id(id)));
  if (row.rows() == 0) return no_such("layer", to_string(id));
  return read_layer(connection, row, 0);
}

// Replaces the formula of the layer and its inputs. Returns an `invalid` error for a layer that is
// computed from itself, directly or through other layers.
Result<void> set_formula(PgConnection& connection, const Layer& layer) {
  auto gone =
      connection.query("DELETE FROM layer_inputs WHERE layer_id = $1", Params().id(layer.id));
  if (!gone) return tl::unexpected(gone.error());
  if (!layer.formula) {
    auto plain = connection.query(
        "UPDATE layers SET expression = NULL, automatic = false, computed_sequence = 0 WHERE id = $1",
        Params().id(layer.id));
    return plain ? Result<void>{} : tl::unexpected(plain.error());
  }
  // Lock the model, so that two concurrent changes cannot create a cycle together.
  STRATA_TRY(connection.query("SELECT 1 FROM models WHERE id = $1 FOR NO KEY UPDATE",
                              Params().id(layer.model_id)));
  for (const LayerFormula::Input& input : layer.formula->inputs) {
    STRATA_TRY(connection.query(
        "INSERT INTO layer_inputs (layer_id, slug, input_id, table_id) VALUES ($1, $2, $3, $4)",
        Params().id(layer.id).text(input.slug).optional_id(input.layer).optional_id(input.table)));
  }
  auto circle = STRATA_TRY(connection.query(
      "WITH RECURSIVE reads (id) AS (SELECT input_id FROM layer_inputs WHERE layer_id = $1 UNION "
      "SELECT i.input_id FROM layer_inputs i JOIN reads r ON i.layer_id = r.id) SELECT 1 FROM reads WHERE id = $1",
      Params().id(layer.id)));
  if (circle.rows() > 0)
    return fail(ErrorCode::invalid, "Layer depends on itself",
                "This expression uses a layer that is computed from " + layer.name + ".",
                "expression");
  auto set = connection.query(
      "UPDATE layers SET expression = $2, automatic = $3, computed_sequence = 0 WHERE id = $1",
      Params().id(layer.id).text(layer.formula->expression).boolean(layer.formula->automatic));
  return set ? Result<void>{} : tl::unexpected(set.error());
}

constexpr std::size_t kMaxDescriptionLength = 40000;  // bytes of 10000 characters
Result<void> keep_origin(PgConnection& connection, LayerId layer_id, const Layer& layer) {
  if (!layer.origin) return {};
  auto inserted = connection.query(
      "INSERT INTO layer_origins (layer_id, origin, edited_by_hand, analysis) VALUES ($1, $2, $3, $4::jsonb) "
      "ON CONFLICT (layer_id) DO UPDATE SET origin = excluded.origin, edited_by_hand = excluded.edited_by_hand, "
      "analysis = excluded.analysis",
      Params()
          .id(layer_id)
          .text(*layer.origin == LayerOrigin::shape ? "shape" : "expression")
          .boolean(layer.edited_by_hand)
          .optional_text(layer.analysis ? std::optional(to_json(*layer.analysis).dump())
                                        : std::nullopt));
  return inserted ? Result<void>{} : tl::unexpected(inserted.error());
}

Result<void> check(const Layer& layer) {
  STRATA_TRY(check_name(layer.name));
  if (!(layer.opacity >= 0 && layer.opacity <= 1))
    return fail(ErrorCode::malformed, "Invalid opacity", "`opacity` must be between 0 and 1.",
                "opacity");
  STRATA_TRY(check_json(to_json(layer.palette), "palette"));
  STRATA_TRY(check_labels(layer.labels));
  if (auto good =
          check_texts_by_language(layer.descriptions, kMaxDescriptionLength, "descriptions");
      !good)
    return good;
  if (layer.group) {
    if (layer.group->empty() || character_count(*layer.group) > kMaxGroupLength)
      return fail(ErrorCode::malformed, "Invalid group", "`group` must be 1 to 60 characters long.",
                  "group");
    STRATA_TRY(check_text(*layer.group, "group"));
  }
  return check_texts(
      {{&layer.slug, "slug"}, {&layer.unit, "unit"}, {&layer.description, "description"}});
}

bool same_formula(const std::optional<LayerFormula>& a, const std::optional<LayerFormula>& b) {
  return a.has_value() == b.has_value() &&
         (!a || (a->expression == b->expression && a->automatic == b->automatic &&
                 a->inputs == b->inputs));
}

// Finds the table of a layer of records in the project of its model, or makes a new table.
Result<void> find_table(PgConnection& connection, Layer& layer, ProjectId project_id,
                        const std::vector<Column>& columns) {
  if (!layer.table) {
    Table table;
    table.project_id = project_id;
    table.name = layer.name;
    table.columns = columns;
    auto made = STRATA_TRY(insert_table(connection, std::move(table)));
    layer.table = made.id;
    return {};
  }
  auto known = STRATA_TRY(connection.query(
      "SELECT 1 FROM record_tables WHERE id = $1 AND project_id = $2 FOR KEY SHARE",
      Params().id(*layer.table).id(project_id)));
  if (known.rows() == 0)
    return fail(ErrorCode::invalid, "Table not found",
                "The model's project has no table " + to_string(*layer.table) + ".", "table");
  return {};
}

}  // namespace

Result<std::vector<Layer>> Layers::of_model(ModelId model_id, Role seen_by) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<Layer>> {
    auto known =
        STRATA_TRY(connection.query("SELECT 1 FROM models WHERE id = $1", Params().id(model_id)));
    if (known.rows() == 0) return no_such("model", to_string(model_id));
    auto rows = STRATA_TRY(connection.query(
        sql("SELECT ", kLayerColumns, " FROM layers WHERE model_id = $1 ORDER BY draw_order, id"),
        Params().id(model_id)));
    std::vector<Layer> layers;
    for (int i = 0; i < rows.rows(); ++i) {
      auto layer = STRATA_TRY(read_layer(connection, rows, i));
      if (sees(seen_by, layer.visibility)) layers.push_back(std::move(layer));
    }
    return layers;
  });
}

Result<Layer> Layers::find(ModelId model_id, const std::string& ref, Role seen_by) {
  if (!check_text(ref, "layer")) return no_such("layer", ref);
  return pool_.read([&](PgConnection& connection) -> Result<Layer> {
    const auto id = id_of<LayerId>(ref);
    auto rows = STRATA_TRY(
        id ? connection.query(
                 sql("SELECT ", kLayerColumns, " FROM layers WHERE model_id = $1 AND id = $2"),
                 Params().id(model_id).id(*id))
           : connection.query(
                 sql("SELECT ", kLayerColumns, " FROM layers WHERE model_id = $1 AND slug = $2"),
                 Params().id(model_id).text(ref)));
    if (rows.rows() == 0) return no_such("layer", ref);
    auto layer = read_layer(connection, rows, 0);
    if (layer && !sees(seen_by, layer->visibility)) return no_such("layer", ref);
    return layer;
  });
}

Result<Layer> Layers::create(Layer layer, const IdempotentResponse<Layer>& answer,
                             std::vector<Column> columns) {
  STRATA_TRY(check(layer));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<Layer> {
    auto model = STRATA_TRY(connection.query(
        "SELECT project_id FROM models WHERE id = $1 FOR KEY SHARE", Params().id(layer.model_id)));
    if (model.rows() == 0) return no_such("model", to_string(layer.model_id));
    if (layer.kind == LayerKind::database)
      STRATA_TRY(find_table(connection, layer, model.id<ProjectId>(0, 0), columns));
    auto row = insert_with_slug(
        connection, "SELECT slug::text FROM layers WHERE slug LIKE $1 AND model_id = $2",
        layer.model_id.number(), layer.slug.empty() ? layer.name : layer.slug,
        [&](const std::string& slug) {
          return connection.query(
              sql("INSERT INTO layers (model_id, name, slug, kind, type, resolution, unit, description, palette, opacity, visible, "
                  "draw_order, table_id, locked, visibility, review, labels, descriptions, group_name, blend) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14, "
                  "$15, $16, $17, $18, $19, $20) "
                  "ON CONFLICT DO NOTHING RETURNING ",
                  kLayerColumns),
              Params()
                  .id(layer.model_id)
                  .text(layer.name)
                  .text(slug)
                  .text(layer.kind == LayerKind::database ? "database" : "numeric")
                  .text(name(layer.type))
                  .integer(layer.resolution)
                  .text(layer.unit)
                  .text(layer.description)
                  .json(palette_to_keep(layer))
                  .real(layer.opacity)
                  .boolean(layer.visible)
                  .integer(layer.order)
                  .optional_id(layer.table)
                  .boolean(layer.locked)
                  .text(name(layer.visibility))
                  .boolean(layer.review)
                  .json(layer.labels)
                  .json(layer.descriptions)
                  .optional_text(layer.group)
                  .text(name(layer.blend)));
        });
    if (!row || (!layer.formula && !layer.origin))
      return row ? read_layer(connection, *row, 0) : tl::unexpected(row.error());
    layer.id = row->id<LayerId>(0, 0);
    STRATA_TRY(keep_origin(connection, layer.id, layer));
    if (!layer.formula) return load_layer(connection, layer.id);
    STRATA_TRY(set_formula(connection, layer));
    return load_layer(connection, layer.id);
  });
}

Result<Layer> Layers::update(Layer layer, const IdempotentResponse<Layer>& answer) {
  STRATA_TRY(check(layer));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<Layer> {
    auto row = STRATA_TRY(connection.query(
        sql("UPDATE layers SET name = $3, slug = $4, unit = $5, description = $6, palette = $7, opacity = $8, visible = $9, "
            "draw_order = $10, locked = $11, visibility = $12, review = $13, labels = $14, descriptions = $15, group_name = $16, blend = $17, version = version + 1 WHERE id = $1 AND version = $2 "
            "RETURNING ",
            kLayerColumns),
        Params()
            .id(layer.id)
            .integer(layer.version)
            .text(layer.name)
            .text(layer.slug)
            .text(layer.unit)
            .text(layer.description)
            .json(palette_to_keep(layer))
            .real(layer.opacity)
            .boolean(layer.visible)
            .integer(layer.order)
            .boolean(layer.locked)
            .text(name(layer.visibility))
            .boolean(layer.review)
            .json(layer.labels)
            .json(layer.descriptions)
            .optional_text(layer.group)
            .text(name(layer.blend))));
    if (row.rows() > 0) {
      auto now = STRATA_TRY(read_layer(connection, row, 0));
      const bool same_origin = now.origin == layer.origin &&
                               now.edited_by_hand == layer.edited_by_hand &&
                               now.analysis == layer.analysis;
      const bool is_same_formula = same_formula(now.formula, layer.formula);
      if (same_origin && is_same_formula) return now;
      STRATA_TRY(keep_origin(connection, layer.id, layer));
      if (is_same_formula) return load_layer(connection, layer.id);
      STRATA_TRY(set_formula(connection, layer));
      return load_layer(connection, layer.id);
    }
    auto known =
        STRATA_TRY(connection.query("SELECT 1 FROM layers WHERE id = $1", Params().id(layer.id)));
    if (known.rows() == 0) return no_such("layer", to_string(layer.id));
    return stale("layer");
  });
}

Result<std::map<TableId, std::int64_t>> Layers::table_sequences_of(LayerId layer_id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::map<TableId, std::int64_t>> {
    auto rows = STRATA_TRY(connection.query(
        "SELECT t.id, t.sequence FROM layer_inputs i JOIN record_tables t ON t.id = i.table_id WHERE i.layer_id = $1",
        Params().id(layer_id)));
    std::map<TableId, std::int64_t> sequences;
    for (int i = 0; i < rows.rows(); ++i) sequences[rows.id<TableId>(i, 0)] = rows.integer(i, 1);
    return sequences;
  });
}

Result<Layer> Layers::set_computed(LayerId layer_id, const std::string& expression,
                                   std::int64_t sequence,
                                   const std::map<TableId, std::int64_t>& tables) {
  return pool_.write([&](PgConnection& connection) -> Result<Layer> {
    STRATA_TRY(connection.query(
        "UPDATE layers SET computed_sequence = $3 WHERE id = $1 AND expression = $2",
        Params().id(layer_id).text(expression).integer(sequence)));
    // The new content overwrites edits made by hand. The layer is locked again, as when it was
    // created.
    STRATA_TRY(connection.query(
        "WITH whole AS (UPDATE layer_origins SET edited_by_hand = false WHERE layer_id = $1 AND edited_by_hand RETURNING layer_id) "
        "UPDATE layers SET locked = true, version = version + 1 FROM whole WHERE id = whole.layer_id",
        Params().id(layer_id)));
    PgArray ids(oid::kInt8), sequences(oid::kInt8);
    for (const auto& [table, at] : tables) {
      ids.add(table);
      sequences.add(at);
    }
    STRATA_TRY(connection.query(
        "UPDATE layer_inputs i SET table_sequence = v.at FROM unnest($2::bigint[], $3::bigint[]) v (id, at) "
        "WHERE i.layer_id = $1 AND i.table_id = v.id",
        Params().id(layer_id).array(ids).array(sequences)));
    return load_layer(connection, layer_id);
  });
}

Result<std::vector<Layer>> Layers::to_recompute() {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<Layer>> {
    auto rows = STRATA_TRY(connection.query(sql(
        "SELECT ", kLayerColumns,
        " FROM layers WHERE automatic AND NOT EXISTS (SELECT 1 FROM layer_origins o WHERE "
        "o.layer_id = layers.id AND o.edited_by_hand) AND ",
        kLayerStale,
        " AND NOT EXISTS (SELECT 1 FROM layer_inputs i WHERE i.layer_id = layers.id AND NOT EXISTS "
        "(SELECT 1 FROM layers l WHERE l.id = i.input_id)) "
        "ORDER BY computed_sequence, id LIMIT 100")));
    std::vector<Layer> layers;
    for (int i = 0; i < rows.rows(); ++i) {
      auto layer = STRATA_TRY(read_layer(connection, rows, i));
      layers.push_back(std::move(layer));
    }
    return layers;
  });
}

namespace {

constexpr int kRevisionsAtOnce = 256, kSegmentsAtOnce = 16;

// Converts differences to the wider type. Their bits stay the same, because the additional bits do
// not differ before and after an edit.
Result<void> widen_revisions(PgConnection& connection, const Layer& layer, ValueType type) {
  for (std::int64_t y = -1, x = 0, sequence = 0;;) {
    auto rows = STRATA_TRY(connection.query(
        "SELECT tile_y, tile_x, sequence, difference, key_tile FROM tile_revisions WHERE layer_id = $1 AND "
        "(tile_y, tile_x, sequence) > ($2, $3, $4) ORDER BY tile_y, tile_x, sequence LIMIT $5",
        Params().id(layer.id).integer(y).integer(x).integer(sequence).integer(kRevisionsAtOnce)));
    if (rows.rows() == 0) return {};
    PgArray ys(oid::kInt8), xs(oid::kInt8), sequences(oid::kInt8), differences(oid::kBytea),
        keys(oid::kBytea);
    for (int i = 0; i < rows.rows(); ++i) {
      y = rows.integer(i, 0), x = rows.integer(i, 1), sequence = rows.integer(i, 2);
      const TileAddress address{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
      auto revision = STRATA_TRY(decode_revision(address, layer.type, rows.bytes(i, 3)));
      revision.difference = widened(revision.difference, type);
      ys.add(y), xs.add(x), sequences.add(sequence);
      differences.add(Bytes(encode_revision(revision)));
      if (rows.null(i, 4)) {
        keys.add_null();
        continue;
      }
      auto tile = STRATA_TRY(decode_tile(layer.type, rows.bytes(i, 4)));
      keys.add(Bytes(encode_tile(widened(tile, type))));
    }
    STRATA_TRY(connection.query(
        "UPDATE tile_revisions r SET difference = n.difference, key_tile = n.key_tile FROM "
        "unnest($2::bigint[], $3::bigint[], $4::bigint[], $5::bytea[], $6::bytea[]) AS n (y, x, sequence, difference, "
        "key_tile) WHERE r.layer_id = $1 AND r.tile_y = n.y AND r.tile_x = n.x AND r.sequence = n.sequence",
        Params().id(layer.id).array(ys).array(xs).array(sequences).array(differences).array(keys)));
  }
}

// Converts segments in the same way.
Result<void> widen_segments(PgConnection& connection, const Layer& layer, ValueType type) {
  for (std::int64_t y = -1, x = 0, first = 0;;) {
    auto rows = STRATA_TRY(connection.query(
        "SELECT tile_y, tile_x, first_sequence, content FROM tile_segments WHERE layer_id = $1 AND "
        "(tile_y, tile_x, first_sequence) > ($2, $3, $4) ORDER BY tile_y, tile_x, first_sequence LIMIT $5",
        Params().id(layer.id).integer(y).integer(x).integer(first).integer(kSegmentsAtOnce)));
    if (rows.rows() == 0) return {};
    PgArray ys(oid::kInt8), xs(oid::kInt8), firsts(oid::kInt8), contents(oid::kBytea);
    for (int i = 0; i < rows.rows(); ++i) {
      y = rows.integer(i, 0), x = rows.integer(i, 1), first = rows.integer(i, 2);
      const TileAddress address{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
      auto segment = STRATA_TRY(decode_segment(address, layer.type, rows.bytes(i, 3)));
      segment.before = widened(segment.before, type);
      for (auto& entry : segment.entries)
        entry.revision.difference = widened(entry.revision.difference, type);
      const auto content = encode_segment(segment);
      if (!content)
        return fail(ErrorCode::internal, "Damaged tile", "A stored segment cannot be converted.");
      ys.add(y), xs.add(x), firsts.add(first);
      contents.add(Bytes(*content));
    }
    STRATA_TRY(connection.query(
        "UPDATE tile_segments s SET content = n.content FROM "
        "unnest($2::bigint[], $3::bigint[], $4::bigint[], $5::bytea[]) AS n (y, x, first, content) "
        "WHERE s.layer_id = $1 AND s.tile_y = n.y AND s.tile_x = n.x AND s.first_sequence = n.first",
        Params().id(layer.id).array(ys).array(xs).array(firsts).array(contents)));
  }
}

}  // namespace

Result<Layer> Layers::widen(const Layer& layer, ValueType type,
                            const IdempotentResponse<Layer>& answer) {
  return change(pool_, answer, [&](PgConnection& connection) -> Result<Layer> {
    auto row = STRATA_TRY(connection.query(
        "UPDATE layers SET type = $3, version = version + 1 WHERE id = $1 AND version = $2 AND type = $4 RETURNING id",
        Params().id(layer.id).integer(layer.version).text(name(type)).text(name(layer.type))));
    if (row.rows() == 0) {
      auto known = load_layer(connection, layer.id);
      return known ? stale("layer") : tl::unexpected(known.error());
    }
    STRATA_TRY(widen_revisions(connection, layer, type));
    STRATA_TRY(widen_segments(connection, layer, type));
    return load_layer(connection, layer.id);
  });
}

Result<void> Layers::remove(LayerId id, const IdempotentResponse<>& answer) {
  const auto work = [&](PgConnection& connection) -> Result<void> {
    auto known =
        STRATA_TRY(connection.query("SELECT 1 FROM layers WHERE id = $1", Params().id(id)));
    return known.rows() > 0 ? erase_layer(connection, id) : no_such("layer", to_string(id));
  };
  return change(pool_, answer, work, kBulkLimits);
}

}  // namespace strata::store
