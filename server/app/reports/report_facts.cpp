#include <chrono>

#include "app/reports/report_parts.h"
#include "core/text/timestamp.h"
#include "domain/scene/model.h"
#include "domain/tables/label_text.h"

namespace strata::app {
namespace {

using Facts = std::vector<std::pair<std::string, std::string>>;

void add(Facts& facts, const char* label, const std::string& value) {
  if (!value.empty()) facts.emplace_back(label, value);
}

report::Paragraph paragraph(std::string text) { return {{{std::move(text)}}}; }

std::string origin_of(const ReportWords& words, const Layer& layer) {
  std::string origin = words.painted;
  if (layer.formula)
    origin = filled(words.computed, layer.formula->expression);
  else if (layer.origin)
    origin = words.from_shape;
  if (layer.analysis) origin += ", " + filled(words.analysis, layer.analysis->name);
  if (layer.edited_by_hand) origin += ", " + std::string(words.edited_by_hand);
  return origin;
}

// Returns the mean area of a texel of a layer, or an empty text if it is not known.
std::string texel_area(const ReportWords& words, const Model& model, int resolution) {
  for (const auto& size : model.atlas.texel_sizes)
    if (size.resolution == resolution)
      return area_in(words, size.area_mean * model.metres() * model.metres());
  return {};
}

}  // namespace

report::Table facts_table(const Facts& facts) {
  constexpr double kLabel = 1, kValue = 3;  // shares of the width
  report::Table table{{{"", kLabel}, {"", kValue}}, {}};
  for (const auto& [label, value] : facts)
    table.rows.push_back({report::Cell{label}, report::Cell{value}});
  return table;
}

std::string layer_name(const ReportContext& context, const Layer& layer) {
  return label_or(layer.labels, context.words.tag, layer.name);
}

Facts title_rows(const ReportContext& context) {
  const ReportWords& words = context.words;
  const Model model = context.request.room->model();
  Facts facts;
  add(facts, words.inventory_number, model.inventory_number);
  add(facts, words.owner, model.owner);
  add(facts, words.author, context.request.author);
  constexpr std::size_t kDay = 10;  // the length of YYYY-MM-DD
  add(facts, words.date, utc_text(std::chrono::system_clock::now()).substr(0, kDay));
  for (const auto& field : context.request.fields) facts.push_back(field);
  return facts;
}

Blocks object_part(const ReportContext& context) {
  const ReportWords& words = context.words;
  const Model model = context.request.room->model();
  const glm::dvec3 size = (model.bounds_max - model.bounds_min) * model.metres();
  Facts facts;
  add(facts, words.object, model.name);
  add(facts, words.inventory_number, model.inventory_number);
  add(facts, words.owner, model.owner);
  add(facts, words.dimensions,
      length_in(words, size.x) + " × " + length_in(words, size.y) + " × " +
          length_in(words, size.z));
  add(facts, words.surface, area_in(words, model.area_m2()));
  add(facts, words.triangles, std::to_string(model.triangles));
  add(facts, words.coordinates, model.crs);
  add(facts, words.survey_date, model.survey_date);
  add(facts, words.creator, model.creator);
  add(facts, words.captured, model.captured);
  add(facts, words.method, model.method);
  add(facts, words.accuracy, model.accuracy);
  add(facts, words.processing, model.processing);
  add(facts, words.credit, model.credit);
  add(facts, words.license, model.rights_uri);
  Blocks blocks{facts_table(facts)};
  if (!model.scale_verified) blocks.emplace_back(paragraph(words.unverified));
  return blocks;
}

Blocks methods_part(const ReportContext& context) {
  const ReportWords& words = context.words;
  const Model model = context.request.room->model();
  Blocks blocks{paragraph(words.method_text)};
  if (context.request.layers.empty()) return blocks;
  report::Table table{{{words.layer, 2},
                       {words.resolution, 1.2, report::Alignment::end},
                       {words.texel, 1.2, report::Alignment::end},
                       {words.origin, 3}},
                      {}};
  for (const Layer& layer : context.request.layers)
    table.rows.push_back({report::Cell{layer_name(context, layer)},
                          report::Cell{std::to_string(layer.resolution) + "²"},
                          report::Cell{texel_area(words, model, layer.resolution)},
                          report::Cell{origin_of(words, layer)}});
  blocks.emplace_back(std::move(table));
  return blocks;
}

Blocks provenance_part(const ReportContext& context) {
  const ReportWords& words = context.words;
  const Model model = context.request.room->model();
  constexpr std::size_t kMinutes = 16;  // the length of YYYY-MM-DDTHH:MM
  std::string time = utc_text(std::chrono::system_clock::now()).substr(0, kMinutes) + " UTC";
  time[10] = ' ';
  Blocks blocks{paragraph(
      filled(words.state_text, std::to_string(context.request.shown.at.value_or(0)), time))};
  if (!model.source_files.empty()) {
    report::Table files{
        {{words.file, 2}, {words.bytes, 1, report::Alignment::end}, {words.sha256, 3}}, {}};
    for (const SourceFile& file : model.source_files)
      files.rows.push_back({report::Cell{file.name}, report::Cell{std::to_string(file.bytes)},
                            report::Cell{file.sha256}});
    blocks.emplace_back(std::move(files));
  }
  if (!model.repairs.empty()) {
    report::Table repairs{{{words.repairs, 4}, {"", 1, report::Alignment::end}}, {}};
    for (const Repair& repair : model.repairs)
      repairs.rows.push_back(
          {report::Cell{repair.what}, report::Cell{std::to_string(repair.count)}});
    blocks.emplace_back(std::move(repairs));
  }
  if (!context.request.layers.empty()) {
    report::Table layers{{{words.layer, 4}, {words.last_edit, 1, report::Alignment::end}}, {}};
    for (const Layer& layer : context.request.layers)
      layers.rows.push_back(
          {report::Cell{layer_name(context, layer)}, report::Cell{std::to_string(layer.sequence)}});
    blocks.emplace_back(std::move(layers));
  }
  return blocks;
}

}  // namespace strata::app
