#include "report/docx_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string_view>

#include "core/text/direction.h"
#include "core/text/hex.h"
#include "report/page.h"
#include "report/picture_bytes.h"
#include "report/style.h"
#include "report/unwritable.h"
#include "report/xml.h"

namespace strata::report {
namespace {

using pugi::xml_node;

// OOXML measures pages in twentieths of a point, and pictures in EMU.
long twips(double mm) { return std::lround(mm / 25.4 * 72 * 20); }
long long emu(double mm) { return std::llround(mm * 36000); }

const char* justification(Alignment alignment) {
  switch (alignment) {
    case Alignment::start: return "left";
    case Alignment::middle: return "center";
    case Alignment::end: return "right";
  }
  return "left";
}

void add_run(xml_node paragraph, const Run& run) {
  if (run.text.empty()) return;
  xml_node node = paragraph.append_child("w:r");
  xml_node properties = node.append_child("w:rPr");
  if (run.bold) {
    properties.append_child("w:b");
    properties.append_child("w:bCs");
  }
  if (run.italic) {
    properties.append_child("w:i");
    properties.append_child("w:iCs");
  }
  if (is_right_to_left(run.text)) properties.append_child("w:rtl");
  if (!properties.first_child()) node.remove_child(properties);
  add_lines(node, run.text);
}

// Writes a swatch as shaded spaces, so that it is part of the text.
void add_swatch(xml_node paragraph, const Color& color) {
  xml_node node = paragraph.append_child("w:r");
  xml_node properties = node.append_child("w:rPr");
  xml_node shading = properties.append_child("w:shd");
  set(shading, "w:val", "clear");
  set(shading, "w:color", "auto");
  set(shading, "w:fill", to_hex(color));
  set(add_text(node, "w:t", "\u00a0\u00a0\u00a0\u00a0\u00a0"), "xml:space", "preserve");
  set(add_text(paragraph.append_child("w:r"), "w:t", " "), "xml:space", "preserve");
}

class Body {
 public:
  Body(const Document& document, const std::filesystem::path& file)
      : document_(document), file_(file) {
    xml_node root = begin_xml(xml_, "w:document");
    set(root, "xmlns:w", "http://schemas.openxmlformats.org/wordprocessingml/2006/main");
    set(root, "xmlns:r", "http://schemas.openxmlformats.org/officeDocument/2006/relationships");
    set(root, "xmlns:wp", "http://schemas.openxmlformats.org/drawingml/2006/wordprocessingDrawing");
    set(root, "xmlns:a", "http://schemas.openxmlformats.org/drawingml/2006/main");
    set(root, "xmlns:pic", "http://schemas.openxmlformats.org/drawingml/2006/picture");
    body_ = root.append_child("w:body");
  }

  Result<DocxBody> write(Progress& progress, double share) {
    STRATA_TRY(add_title());
    for (std::size_t i = 0; i < document_.blocks.size(); ++i) {
      if (progress.cancelled()) return cancelled_problem();
      progress.report(share * static_cast<double>(i) / static_cast<double>(document_.blocks.size()),
                      "Writing the report");
      place_ = "blocks/" + std::to_string(i);
      STRATA_TRY(std::visit([&](const auto& block) { return add(block); }, document_.blocks[i]));
    }
    add_section();
    return DocxBody{xml_text(xml_), std::move(pictures_)};
  }

 private:
  xml_node add_paragraph(xml_node parent, const char* style, const std::string& text,
                         Alignment alignment = Alignment::start, bool keeps_next = false) {
    xml_node paragraph = parent.append_child("w:p");
    xml_node properties = paragraph.append_child("w:pPr");
    add_value(properties, "w:pStyle", style);
    if (keeps_next) properties.append_child("w:keepNext");
    if (begins_page_) properties.append_child("w:pageBreakBefore");
    begins_page_ = false;
    if (is_right_to_left(text)) properties.append_child("w:bidi");
    if (alignment != Alignment::start) add_value(properties, "w:jc", justification(alignment));
    return paragraph;
  }
  xml_node add_text_paragraph(xml_node parent, const char* style, const std::string& text) {
    xml_node paragraph = add_paragraph(parent, style, text);
    add_run(paragraph, {text});
    return paragraph;
  }
  void add_runs(const char* style, const std::vector<Run>& runs) {
    std::string text;
    for (const Run& run : runs) text += run.text;
    xml_node paragraph = add_paragraph(body_, style, text);
    for (const Run& run : runs) add_run(paragraph, run);
  }

  Result<void> add(const Heading& heading) {
    const std::string style = "Heading" + std::to_string(heading.level);
    add_text_paragraph(body_, style.c_str(), heading.text);
    return {};
  }
  Result<void> add(const Paragraph& paragraph) {
    add_runs("BodyText", paragraph.runs);
    return {};
  }
  Result<void> add(const ListItem& item) {
    add_runs("ListBullet", item.runs);
    return {};
  }
  Result<void> add(const PageBreak&) {
    begins_page_ = true;
    return {};
  }

  Result<void> add(const Picture& picture) {
    const PictureBytes bytes = STRATA_TRY(read_picture(picture.source, place_));
    const ShownSize size = shown_size(picture.width_mm, bytes.width, bytes.height,
                                      kMaxPictureWidth_mm, kMaxPictureHeight_mm);
    const std::string caption = caption_of(picture, size, document_.wording);
    xml_node paragraph = add_paragraph(body_, "Picture", "", Alignment::start, !caption.empty());
    STRATA_TRY(add_drawing(paragraph, bytes, picture.source, size, picture.alternative));
    if (!caption.empty()) add_text_paragraph(body_, "Caption", caption);
    return {};
  }

  Result<void> add(const Table& table) {
    if (!table.caption.empty())
      add_text_paragraph(body_, "TableCaption", table.caption);
    else  // Word joins tables without a paragraph between them.
      add_paragraph(body_, "TableGap", "");
    const std::vector<double> widths_mm = column_widths_mm(table);
    xml_node node = begin_table(has_rules(table) ? "ReportTable" : "PlainTable", widths_mm);
    xml_node look = node.child("w:tblPr").append_child("w:tblLook");
    set(look, "w:firstRow", has_head(table) ? 1 : 0);
    set(look, "w:lastRow", table.total.empty() ? 0 : 1);
    set(look, "w:firstColumn", 0);
    set(look, "w:lastColumn", 0);
    set(look, "w:noHBand", 1);
    set(look, "w:noVBand", 1);
    if (has_head(table)) {
      std::vector<Cell> names;
      for (const Column& column : table.columns) names.push_back({column.name});
      STRATA_TRY(add_row(node, table, widths_mm, names, "TableHead"));
      node.last_child().child("w:trPr").append_child("w:tblHeader");
    }
    for (const auto& row : table.rows)
      STRATA_TRY(add_row(node, table, widths_mm, row, "TableText"));
    if (!table.total.empty())
      STRATA_TRY(add_row(node, table, widths_mm, table.total, "TableTotal"));
    // The element must have a row.
    if (!node.child("w:tr")) STRATA_TRY(add_row(node, table, widths_mm, {}, "TableText"));
    add_paragraph(body_, "TableGap", "");
    return {};
  }

  Result<void> add_row(xml_node table_node, const Table& table,
                       const std::vector<double>& widths_mm, const std::vector<Cell>& cells,
                       const char* style) {
    xml_node row = table_node.append_child("w:tr");
    row.append_child("w:trPr").append_child("w:cantSplit");
    for (std::size_t i = 0; i < widths_mm.size(); ++i) {
      const Cell cell = i < cells.size() ? cells[i] : Cell{};
      xml_node node = add_cell(row, widths_mm[i]);
      xml_node paragraph = add_paragraph(node, style, cell.text, table.columns[i].alignment);
      if (cell.picture) {
        const PictureBytes bytes = STRATA_TRY(read_picture(cell.picture->source, place_));
        const ShownSize size =
            shown_size(cell.picture->width_mm, bytes.width, bytes.height,
                       widths_mm[i] - 2 * kCellPadding_mm, kMaxCellPictureHeight_mm);
        STRATA_TRY(
            add_drawing(paragraph, bytes, cell.picture->source, size, cell.picture->alternative));
        if (!cell.text.empty()) paragraph.append_child("w:r").append_child("w:br");
      }
      if (cell.swatch) add_swatch(paragraph, *cell.swatch);
      add_run(paragraph, {cell.text});
    }
    return {};
  }

  Result<void> add_title() {
    if (document_.logo) {
      place_ = "logo";
      const Logo& logo = *document_.logo;
      const PictureBytes bytes = STRATA_TRY(read_picture(logo.source, place_));
      const ShownSize size =
          shown_size(logo.width_mm, bytes.width, bytes.height, kMaxLogoWidth_mm, kMaxLogoHeight_mm);
      xml_node table = begin_table("PlainTable", {kTextWidth_mm - size.width_mm, size.width_mm});
      xml_node row = table.append_child("w:tr");
      add_title_texts(add_cell(row, kTextWidth_mm - size.width_mm), true);
      xml_node cell = add_cell(row, size.width_mm);
      xml_node paragraph = add_paragraph(cell, "Logo", "", Alignment::end);
      STRATA_TRY(add_drawing(paragraph, bytes, logo.source, size, logo.alternative));
    } else {
      add_title_texts(body_, false);
    }
    if (document_.title_block.empty()) return {};
    add_paragraph(body_, "TitleRule", "");
    xml_node table = begin_table("PlainTable", {kLabelWidth_mm, kTextWidth_mm - kLabelWidth_mm});
    for (const auto& [label, value] : document_.title_block) {
      xml_node row = table.append_child("w:tr");
      row.append_child("w:trPr").append_child("w:cantSplit");
      add_text_paragraph(add_cell(row, kLabelWidth_mm), "TitleLabel", label);
      add_text_paragraph(add_cell(row, kTextWidth_mm - kLabelWidth_mm), "TitleValue", value);
    }
    add_paragraph(body_, "TitleRule", "");
    return {};
  }
  // A cell must have a paragraph.
  void add_title_texts(xml_node parent, bool is_cell) {
    if (!document_.title.empty() || is_cell) add_text_paragraph(parent, "Title", document_.title);
    if (!document_.subject.empty()) add_text_paragraph(parent, "Subtitle", document_.subject);
  }

  xml_node begin_table(const char* style, const std::vector<double>& widths_mm) {
    xml_node table = body_.append_child("w:tbl");
    xml_node properties = table.append_child("w:tblPr");
    add_value(properties, "w:tblStyle", style);
    xml_node width = properties.append_child("w:tblW");
    set(width, "w:w", twips(kTextWidth_mm));
    set(width, "w:type", "dxa");
    set(properties.append_child("w:tblLayout"), "w:type", "fixed");
    xml_node grid = table.append_child("w:tblGrid");
    for (const double width_mm : widths_mm)
      set(grid.append_child("w:gridCol"), "w:w", twips(width_mm));
    return table;
  }
  xml_node add_cell(xml_node row, double width_mm) {
    xml_node cell = row.append_child("w:tc");
    xml_node width = cell.append_child("w:tcPr").append_child("w:tcW");
    set(width, "w:w", twips(width_mm));
    set(width, "w:type", "dxa");
    return cell;
  }

  Result<void> add_drawing(xml_node paragraph, const PictureBytes& bytes,
                           const PictureSource& source, const ShownSize& size,
                           const std::string& alternative) {
    const std::string number = std::to_string(pictures_.size() + 1);
    DocxPicture picture{
        "word/media/picture" + number + (bytes.format == PictureFormat::jpeg ? ".jpg" : ".png"),
        "picture" + number, bytes.format, source, nullptr};
    if (!bytes.is_source) {
      picture.converted = std::make_unique<TemporaryFile>(file_.string() + ".picture-" + number);
      std::ofstream stream(picture.converted->path, std::ios::binary);
      stream.write(reinterpret_cast<const char*>(bytes.bytes->data()),
                   static_cast<std::streamsize>(bytes.bytes->size()));
      if (!stream.flush()) return unwritable();
    }
    const std::string name = "Picture " + number;
    const auto set_extent = [&](xml_node node) {
      set(node, "cx", emu(size.width_mm));
      set(node, "cy", emu(size.height_mm));
    };
    xml_node frame =
        paragraph.append_child("w:r").append_child("w:drawing").append_child("wp:inline");
    for (const char* distance : {"distT", "distB", "distL", "distR"}) set(frame, distance, 0);
    set_extent(frame.append_child("wp:extent"));
    xml_node properties = frame.append_child("wp:docPr");
    set(properties, "id", number);
    set(properties, "name", name);
    set(properties, "descr", alternative);
    xml_node locks = frame.append_child("wp:cNvGraphicFramePr").append_child("a:graphicFrameLocks");
    set(locks, "noChangeAspect", 1);
    xml_node data = frame.append_child("a:graphic").append_child("a:graphicData");
    set(data, "uri", "http://schemas.openxmlformats.org/drawingml/2006/picture");
    xml_node node = data.append_child("pic:pic");
    xml_node names = node.append_child("pic:nvPicPr");
    xml_node picture_properties = names.append_child("pic:cNvPr");
    set(picture_properties, "id", number);
    set(picture_properties, "name", name);
    names.append_child("pic:cNvPicPr");
    xml_node fill = node.append_child("pic:blipFill");
    set(fill.append_child("a:blip"), "r:embed", picture.relationship);
    fill.append_child("a:stretch").append_child("a:fillRect");
    xml_node shape = node.append_child("pic:spPr");
    xml_node frame_on_page = shape.append_child("a:xfrm");
    xml_node offset = frame_on_page.append_child("a:off");
    set(offset, "x", 0);
    set(offset, "y", 0);
    set_extent(frame_on_page.append_child("a:ext"));
    xml_node geometry = shape.append_child("a:prstGeom");
    set(geometry, "prst", "rect");
    geometry.append_child("a:avLst");
    pictures_.push_back(std::move(picture));
    return {};
  }

  // The page, its header and its footer. The first page has no header.
  void add_section() {
    xml_node section = body_.append_child("w:sectPr");
    const auto refer = [&](const char* element, const char* type, const char* relationship) {
      xml_node node = section.append_child(element);
      set(node, "w:type", type);
      set(node, "r:id", relationship);
    };
    refer("w:headerReference", "default", kHeaderRelationship);
    refer("w:footerReference", "default", kFooterRelationship);
    refer("w:footerReference", "first", kFooterRelationship);
    xml_node size = section.append_child("w:pgSz");
    set(size, "w:w", twips(kPageWidth_mm));
    set(size, "w:h", twips(kPageHeight_mm));
    xml_node margins = section.append_child("w:pgMar");
    const std::array<std::pair<const char*, double>, 7> lengths{{{"w:top", kTopMargin_mm},
                                                                 {"w:right", kMargin_mm},
                                                                 {"w:bottom", kBottomMargin_mm},
                                                                 {"w:left", kMargin_mm},
                                                                 {"w:header", kHeader_mm},
                                                                 {"w:footer", kFooter_mm},
                                                                 {"w:gutter", 0}}};
    for (const auto& [name, mm] : lengths) set(margins, name, twips(mm));
    section.append_child("w:titlePg");
  }

  const Document& document_;
  const std::filesystem::path& file_;
  pugi::xml_document xml_;
  xml_node body_;
  bool begins_page_ = false;
  std::string place_;  // of the current block
  std::vector<DocxPicture> pictures_;
};

}  // namespace

Result<DocxBody> docx_body(const Document& document, const std::filesystem::path& file,
                           Progress& progress, double share) {
  return Body(document, file).write(progress, share);
}

}  // namespace strata::report
