#pragma once

#include <memory>
#include <vector>

#include "app/reports/report.h"
#include "report/document.h"

// The sections of a condition report, as blocks without their headings and without the user's
// texts. A section without content has no blocks.
namespace strata::app {

// What the functions need. All members must outlive the call.
struct ReportContext {
  const Services& services;
  ByteBudget& budget;
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

// Draws the surface around a record, `bounds` in world coordinates. Returns a PNG that is
// kPlaceWidth_mm wide, or null if there is no surface near the record.
inline constexpr double kPlaceWidth_mm = 78;
Result<std::shared_ptr<const TemporaryFile>> place_picture(const ReportContext& context,
                                                           const Layer& layer, std::int64_t key,
                                                           const glm::dvec3& bounds_min,
                                                           const glm::dvec3& bounds_max);

// Returns a table without a first row.
report::Table facts_table(const std::vector<std::pair<std::string, std::string>>& facts);
std::string layer_name(const ReportContext& context, const Layer& layer);

}  // namespace strata::app
