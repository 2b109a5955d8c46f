#include "app/reports/report.h"

#include <algorithm>
#include <chrono>

#include "app/reports/report_parts.h"
#include "core/uuid.h"
#include "domain/people/question.h"
#include "domain/scene/model.h"
#include "report/writers.h"
#include "room/room.h"

namespace strata::app {
namespace {

const char* heading_of(const ReportWords& words, ReportPart part) {
  switch (part) {
    case ReportPart::object: return words.object;
    case ReportPart::condition: return words.condition;
    case ReportPart::figures: return words.figures;
    case ReportPart::quantities: return words.quantities;
    case ReportPart::findings: return words.findings;
    case ReportPart::measures: return words.measures;
    case ReportPart::methods: return words.methods;
    case ReportPart::provenance: return words.provenance;
  }
  return "";
}

// The share of the progress that a section has in comparison with the others.
double weight_of(ReportPart part) {
  constexpr double kText = 0.1, kCounts = 1, kFigures = 5, kFindings = 20;
  switch (part) {
    case ReportPart::figures: return kFigures;
    case ReportPart::quantities: return kCounts;
    case ReportPart::findings: return kFindings;
    default: return kText;
  }
}

Result<Blocks> content_of(const ReportContext& context, ReportPart part, Progress& progress) {
  switch (part) {
    case ReportPart::object: return object_part(context);
    case ReportPart::figures: return figures_part(context, progress);
    case ReportPart::quantities: return quantities_part(context, progress);
    case ReportPart::findings: return findings_part(context, progress);
    case ReportPart::methods: return methods_part(context);
    case ReportPart::provenance: return provenance_part(context);
    case ReportPart::condition:
    case ReportPart::measures: break;
  }
  return Blocks{};
}

// Returns the paragraphs of a text, which empty lines separate.
Blocks paragraphs_of(const std::string& text) {
  Blocks blocks;
  std::string current;
  const auto finish = [&] {
    if (!current.empty()) blocks.emplace_back(report::Paragraph{{{current}}});
    current.clear();
  };
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    std::string line = text.substr(from, end - from);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.find_first_not_of(" \t") == std::string::npos)
      finish();
    else
      current += (current.empty() ? "" : "\n") + line;
    from = end + 1;
  }
  finish();
  return blocks;
}

Result<report::Document> document_of(const ReportContext& context, Progress& progress,
                                     double share) {
  const ReportRequest& request = context.request;
  report::Document document;
  document.title = request.title;
  document.subject = request.subject.empty() ? context.words.report : request.subject;
  document.author = request.author;
  document.language = context.words.tag;
  document.created = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  if (request.logo) document.logo = report::Logo{.source = request.logo, .alternative = {}};
  document.title_block = title_rows(context);
  document.header = request.title + " – " + document.subject;
  document.footer = request.author;
  document.wording.reduced = context.words.reduced;
  double whole = 0, done = 0;
  for (const auto& section : request.sections) whole += weight_of(section.part);
  for (const auto& section : request.sections) {
    check_question();
    if (progress.cancelled()) return cancelled_problem();
    const double weight = weight_of(section.part);
    progress.begin_stage(share * done / whole, share * (done + weight) / whole);
    done += weight;
    Blocks text = paragraphs_of(section.text);
    Blocks content = STRATA_TRY(content_of(context, section.part, progress));
    if (text.empty() && content.empty()) continue;
    document.blocks.emplace_back(report::Heading{
        1, section.heading.empty() ? heading_of(context.words, section.part) : section.heading});
    std::ranges::move(text, std::back_inserter(document.blocks));
    std::ranges::move(content, std::back_inserter(document.blocks));
  }
  return document;
}

}  // namespace

Result<std::shared_ptr<const TemporaryFile>> make_report(const Services& services,
                                                         ByteBudget& budget,
                                                         const ReportRequest& request,
                                                         const std::filesystem::path& folder,
                                                         Progress& progress) {
  constexpr double kContent = 0.9;  // the rest of the progress is for the file
  // Holds the memory during the whole report, because a report must not fail at its last drawing.
  const auto held = STRATA_TRY(budget.take(drawing_bytes()));
  ByteBudget own(drawing_bytes());
  std::vector<std::shared_ptr<const TemporaryFile>> files;
  const ReportContext context{services, own, request, words_in(request.language), folder, files};
  const report::Document document = STRATA_TRY(document_of(context, progress, kContent));
  progress.begin_stage(kContent, 1);
  progress.report(0, "Writing the report");
  const bool is_docx = request.format == ReportFormat::docx;
  auto file = std::make_shared<TemporaryFile>();
  file->path = folder / (to_string(random_uuid()) + ".report");
  file->name = request.room->model().slug + "-report" + (is_docx ? ".docx" : ".pdf");
  file->media_type = is_docx
                         ? "application/vnd.openxmlformats-officedocument.wordprocessingml.document"
                         : "application/pdf";
  auto written = is_docx ? report::write_docx(document, file->path, progress)
                         : report::write_pdf(document, file->path, progress);
  if (!written) {
    Error problem = std::move(written.error());
    // The fields of all other parts of the document are not in the user's request.
    problem.field = problem.field.starts_with("logo") ? "logo" : "";
    return tl::unexpected(std::move(problem));
  }
  file->bytes = std::filesystem::file_size(file->path);
  return file;
}

}  // namespace strata::app
