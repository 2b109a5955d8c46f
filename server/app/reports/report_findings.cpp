#include <algorithm>
#include <fstream>

#include "app/figures/class_names.h"
#include "app/records/record_measures.h"
#include "app/records/record_words.h"
#include "app/reports/report_parts.h"
#include "core/uuid.h"
#include "domain/scene/model.h"
#include "domain/tables/attachment.h"
#include "domain/tables/column_value.h"
#include "domain/tables/label_text.h"
#include "media/thumbnail.h"
#include "room/queries.h"
#include "room/room.h"
#include "store/tables/attachments.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::app {
namespace {

// Limits the time and the size of a report with many layers.
constexpr std::size_t kMaxRecords = 2000;
constexpr std::size_t kMaxPictures = 4;  // of each record
constexpr std::uint64_t kMaxPictureBytes = 64u << 20;
constexpr int kPictureSide = 1000;  // pixels

// The records of a layer.
struct Findings {
  const Layer& layer;
  store::RecordPage page;
  std::map<std::int64_t, query::KeyArea> places;
  RecordNames names;
  WordsOfTables words;
};

std::string cell_text(const ReportContext& context, const Findings& findings, const Record& record,
                      const Column& column) {
  const auto value = record.values.find(column.id);
  if (value == record.values.end() || value->second.is_null()) return {};
  if (column.kind == ColumnKind::boolean)
    return value->second.get<bool>() ? context.words.yes : context.words.no;
  if (column.kind == ColumnKind::term && column.target) {
    const auto known = findings.words.find(*column.target);
    if (known != findings.words.end()) return known->second.name(value->second.get<std::int64_t>());
  }
  std::string text = print_value(column, value->second);
  // All digits of the value remain.
  const auto point = text.find('.');
  if (column.kind == ColumnKind::numeric && point != std::string::npos)
    text.replace(point, 1, context.words.decimal);
  if (!column.unit.empty()) text += " " + column.unit;
  return text;
}

std::vector<std::pair<std::string, std::string>> facts_of(const ReportContext& context,
                                                          const Findings& findings,
                                                          const Record& record,
                                                          const RecordMeasures& measures) {
  std::vector<std::pair<std::string, std::string>> facts;
  for (const Column& column : findings.page.table.columns) {
    if (holds_attachments(column.kind) || holds_features(column.kind)) continue;
    std::string text = cell_text(context, findings, record, column);
    if (!text.empty())
      facts.emplace_back(label_or(column.labels, context.words.tag, column.name), std::move(text));
  }
  const double area_m2 = findings.places.at(record.key).area_m2;
  if (area_m2 > 0) facts.emplace_back(context.words.area, area_in(context.words, area_m2));
  const auto values = measures.of(record);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] > 0)) continue;
    if (measures.names()[i] == kLengthMeasure)
      facts.emplace_back(context.words.length, length_in(context.words, values[i]));
    else
      facts.emplace_back(context.words.points, number_in(context.words, values[i]));
  }
  return facts;
}

// Writes a picture to a file, because the pictures of all records can be larger than the memory.
Result<report::CellPicture> stored(const ReportContext& context,
                                   const std::vector<std::uint8_t>& bytes,
                                   const std::string& name) {
  auto file = std::make_shared<TemporaryFile>(context.folder / (to_string(random_uuid()) + ".jpg"));
  std::ofstream out(file->path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  if (!out.flush())
    return fail(ErrorCode::storage_full, "Report not written",
                "The server could not write a picture to its disk. Free disk space.");
  context.files.push_back(file);
  return report::CellPicture{file->path, kPlaceWidth_mm, name};
}

// Returns a small version of a picture, or nullopt if the file is too large or no picture.
Result<std::optional<std::vector<std::uint8_t>>> small_version(store::Attachments& attachments,
                                                               const Attachment& file) {
  if (file.bytes > kMaxPictureBytes) return std::nullopt;
  std::vector<std::uint8_t> bytes;
  const auto read =
      attachments.read(file.sha256, 0, file.bytes, [&](std::span<const std::uint8_t> part) {
        bytes.insert(bytes.end(), part.begin(), part.end());
        return true;
      });
  if (!read && read.error().code == ErrorCode::not_found) return std::nullopt;
  if (!read) return tl::unexpected(read.error());
  auto small = make_thumbnail(bytes, kPictureSide);
  if (!small) return std::nullopt;
  return std::move(*small);
}

// Returns small versions of the pictures of a record. Names the files that cannot be shown, because
// a report without one of them is better than no report.
Result<std::vector<report::Cell>> pictures_of(const ReportContext& context,
                                              const Findings& findings, const Record& record) {
  std::vector<AttachmentId> ids;
  for (const Column& column : findings.page.table.columns) {
    const auto value = record.values.find(column.id);
    if (column.kind != ColumnKind::picture || value == record.values.end()) continue;
    for (const auto& id : value->second) ids.push_back(id.get<AttachmentId>());
  }
  std::vector<report::Cell> cells;
  if (ids.empty()) return cells;
  store::Attachments& attachments = context.services.store.attachments();
  const auto found =
      STRATA_TRY(attachments.of_table(findings.page.table.id, context.request.reader, ids));
  for (const AttachmentId id : ids) {
    const auto file = std::ranges::find(found, id, &Attachment::id);
    if (cells.size() == kMaxPictures) break;
    if (file == found.end()) continue;
    report::Cell& cell = cells.emplace_back(report::Cell{file->name});
    const auto small = STRATA_TRY(small_version(attachments, *file));
    if (small) {
      auto picture = STRATA_TRY(stored(context, *small, file->name));
      cell.picture = std::move(picture);
    } else {
      cell.text = filled(context.words.not_shown, file->name);
    }
  }
  return cells;
}

Result<void> add_record(const ReportContext& context, const Findings& findings,
                        const Record& record, const RecordMeasures& measures, Progress& progress,
                        Blocks& blocks) {
  blocks.emplace_back(report::Heading{3, record_label(context.words, findings.names, record.key)});
  const auto facts = facts_of(context, findings, record, measures);
  if (!facts.empty()) blocks.emplace_back(facts_table(facts));
  std::vector<report::Cell> cells;
  if (context.request.record_pictures) {
    auto picture = STRATA_TRY(place_picture(context, findings.layer, record.key,
                                            findings.places.at(record.key), progress));
    if (picture) {
      report::Cell cell{context.words.place};
      cell.picture = report::CellPicture{picture->path, kPlaceWidth_mm, context.words.place};
      cells.push_back(std::move(cell));
      context.files.push_back(std::move(picture));
    }
  }
  auto pictures = STRATA_TRY(pictures_of(context, findings, record));
  std::ranges::move(pictures, std::back_inserter(cells));
  if (cells.empty()) return {};
  report::Table table{{{"", 1}, {"", 1}}, {}};
  for (std::size_t i = 0; i < cells.size(); i += 2) {
    auto& row = table.rows.emplace_back();
    row.push_back(std::move(cells[i]));
    if (i + 1 < cells.size()) row.push_back(std::move(cells[i + 1]));
  }
  blocks.emplace_back(std::move(table));
  return {};
}

// A part of the progress of a section.
struct Share {
  double from, size;
};

// Adds at most `limit` records, and returns how many.
Result<std::size_t> add_layer(const ReportContext& context, const Layer& layer, std::size_t limit,
                              const Share& share, Progress& progress, Blocks& blocks) {
  const ReportRequest& request = context.request;
  store::Store& store = context.services.store;
  Findings findings{layer, {}, {}, {}, {}};
  auto places = STRATA_TRY(record_places(context, layer));
  findings.places = std::move(places);
  store::RecordQuery query;
  query.keys.emplace();
  for (const auto& [key, place] : findings.places) query.keys->push_back(key);
  if (query.keys->empty()) return 0;
  const auto at = records_at(context, layer);
  query.at = at;
  auto page = STRATA_TRY(store.records().page(*layer.table, request.reader.role, query));
  findings.page = std::move(page);
  auto names = STRATA_TRY(
      record_names(store, *layer.table, request.reader.role, *query.keys, at, context.words.tag));
  findings.names = std::move(names);
  const auto& columns = findings.page.table.columns;
  auto words = STRATA_TRY(words_of(store, columns, request.reader.role, context.words.tag));
  findings.words = std::move(words);
  const auto measures = RecordMeasures::of_place(
      context.services, {findings.page.table, request.room->model(), {}}, columns);
  if (!measures) return tl::unexpected(measures.error());
  const std::size_t total = findings.page.records.size(),
                    shown = std::min({total, request.max_records, limit});
  if (total == 0) return 0;
  blocks.emplace_back(report::Heading{2, layer_name(context, layer)});
  if (shown < total)
    blocks.emplace_back(report::Paragraph{
        {{filled(context.words.omitted, std::to_string(shown), std::to_string(total))}}});
  for (std::size_t i = 0; i < shown; ++i) {
    if (progress.cancelled()) return cancelled_problem();
    progress.report(share.from + share.size * static_cast<double>(i) / static_cast<double>(shown),
                    "Describing record " + std::to_string(i + 1) + " of " + std::to_string(shown));
    STRATA_TRY(
        add_record(context, findings, findings.page.records[i], *measures, progress, blocks));
  }
  return shown;
}

}  // namespace

Result<Blocks> findings_part(const ReportContext& context, Progress& progress) {
  Blocks blocks;
  if (context.request.max_records == 0) return blocks;
  const auto has_records = [](const Layer& layer) { return layer.table.has_value(); };
  const double size =
      1.0 / static_cast<double>(std::ranges::count_if(context.request.layers, has_records));
  std::size_t left = kMaxRecords;
  Share share{0, size};
  // The topmost layer first, as in legends.
  for (auto layer = context.request.layers.rbegin(); layer != context.request.layers.rend();
       ++layer) {
    if (!has_records(*layer)) continue;
    left -= STRATA_TRY(add_layer(context, *layer, left, share, progress, blocks));
    share.from += size;
  }
  return blocks;
}

}  // namespace strata::app
