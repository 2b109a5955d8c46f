#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/figures/figures.h"
#include "app/reports/report_words.h"
#include "app/services.h"
#include "domain/people/role.h"

namespace strata::app {

enum class ReportFormat { docx, pdf };
// The sections of a condition report. The order is that of the API, and that of a report whose
// request does not set it.
enum class ReportPart {
  object,
  condition,
  figures,
  quantities,
  findings,
  measures,
  methods,
  provenance
};

// The settings of a condition report. The caller has checked the user's request.
struct ReportRequest {
  struct Section {
    ReportPart part = ReportPart::object;
    std::string heading;  // empty: the name of the section
    std::string text;     // paragraphs that are separated by empty lines
  };
  struct MeasuredFigure {
    FigureRequest request;  // its sheet, format and captions are set by the report
    std::string caption;
  };

  std::shared_ptr<room::Room> room;  // as visible to the reader
  Author reader;                     // sees what this user may see
  ReportFormat format = ReportFormat::docx;
  ReportLanguage language = ReportLanguage::en;
  std::string title{}, subject{}, author{};
  std::vector<std::pair<std::string, std::string>> fields{};  // rows of the title block
  std::shared_ptr<const std::vector<std::uint8_t>> logo{};    // PNG or JPEG; null: no logo
  std::vector<Section> sections{};
  std::vector<Layer> layers{};   // from bottom to top
  room::PictureRequest shown{};  // contains the sequence that the whole report shows
  std::map<TableId, std::int64_t> records_at{};  // the sequences of all layers' tables
  std::vector<MeasuredFigure> figures{};
  std::size_t max_records = 100;  // of each layer
  bool record_pictures = true;    // draw the place of each record
};

// Writes a condition report to a file in `folder`. `budget` is that of figures. Returns the errors
// of make_figure and of report/writers.h. The field is `logo` for a logo that cannot be read, and
// "figures[i]" for a figure that cannot be drawn. Blocks.
Result<std::shared_ptr<const TemporaryFile>> make_report(const Services& services,
                                                         ByteBudget& budget,
                                                         const ReportRequest& request,
                                                         const std::filesystem::path& folder,
                                                         Progress& progress);

}  // namespace strata::app
