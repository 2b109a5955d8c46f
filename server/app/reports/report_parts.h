#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/reports/report.h"
#include "query/statistics/key_areas.h"
#include "report/document.h"

// The sections of a condition report, as blocks without their headings and without the user's
// texts. A section without content has no blocks.
namespace strata::app {

// What the functions need. All members must outlive the call.
struct ReportContext {
  const Services& services;
  ByteBudget& budget;  // for one drawing
  const ReportRequest& request;
  const ReportWords& words;
  const std::filesystem::path& folder;
  // The files of the pictures, which must exist until the report is written.
  std::vector<std::shared_ptr<const TemporaryFile>>& files;
};
using Blocks = std::vector<report::Block>;

// Rows of the title block: the author, the date, and what identifies the object.
std::vector<std::pair<std::string, std::string>> title_rows(const ReportContext& context);

Blocks object_part(const ReportContext& context);
Result<Blocks> figures_part(const ReportContext& context, Progress& progress);
Result<Blocks> quantities_part(const ReportContext& context, Progress& progress);
Result<Blocks> findings_part(const ReportContext& context, Progress& progress);
Blocks methods_part(const ReportContext& context);
Blocks provenance_part(const ReportContext& context);

// The memory of the largest drawing.
std::uint64_t drawing_bytes();
// Draws the surface around a record, with its lines and points. Returns a PNG that is
// kPlaceWidth_mm wide, or null if there is no surface near the record.
inline constexpr double kPlaceWidth_mm = 78;
Result<std::shared_ptr<const TemporaryFile>> place_picture(const ReportContext& context,
                                                           const Layer& layer, std::int64_t key,
                                                           const query::KeyArea& place,
                                                           Progress& progress);

// Returns the sequence of the layer's table that the report shows.
std::int64_t records_at(const ReportContext& context, const Layer& layer);
// Returns the areas of the records that are painted on a layer or that have lines or points on its
// model. The boxes include the lines and points.
Result<std::map<std::int64_t, query::KeyArea>> record_places(const ReportContext& context,
                                                             const Layer& layer);
// Returns the name of a record, or its number if it has no name or does not exist.
std::string record_label(const ReportWords& words, const std::map<std::int64_t, std::string>& names,
                         std::int64_t key);

// Returns a table without a first row.
report::Table facts_table(const std::vector<std::pair<std::string, std::string>>& facts);
std::string layer_name(const ReportContext& context, const Layer& layer);

}  // namespace strata::app
