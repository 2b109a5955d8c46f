#include "report/docx_styles.h"

#include <cmath>

#include "core/text/hex.h"
#include "report/page.h"
#include "report/style.h"
#include "report/xml.h"

namespace strata::report {
namespace {

using pugi::xml_node;

// All word processors have this font or one of the same widths. The font of the PDF has the same
// widths, too.
constexpr const char* kFont = "Arial";

long twips(double points) { return std::lround(points * 20); }
long twips_of_mm(double mm) { return twips(mm / 25.4 * 72); }

void add_spacing(xml_node properties, double before_pt, double after_pt, double lines) {
  constexpr double kLine = 240;  // the unit of proportional spacing
  xml_node spacing = properties.append_child("w:spacing");
  set(spacing, "w:before", twips(before_pt));
  set(spacing, "w:after", twips(after_pt));
  set(spacing, "w:line", std::lround(lines * kLine));
  set(spacing, "w:lineRule", "auto");
}

void add_border(xml_node borders, const char* side, double width_pt, const Color& color) {
  xml_node border = borders.append_child(side);
  set(border, "w:val", "single");
  set(border, "w:sz", std::lround(width_pt * 8));
  set(border, "w:space", 0);
  set(border, "w:color", to_hex(color));
}

xml_node add_style(xml_node root, const char* type, const char* id, const char* name,
                   const char* based_on) {
  xml_node style = root.append_child("w:style");
  set(style, "w:type", type);
  set(style, "w:styleId", id);
  add_value(style, "w:name", name);
  if (based_on != nullptr) add_value(style, "w:basedOn", based_on);
  return style;
}

struct ParagraphStyle {
  const char *id, *name;
  TextStyle text{};
  const char* next = nullptr;
  int outline_level = -1;  // of headings, from 0
  bool keeps_next = false, is_list = false;
  double tab_mm = 0;  // of a tab at the right margin
  bool has_rule = false;
  const char* based_on = "Normal";
};

void add(xml_node root, const ParagraphStyle& style) {
  xml_node node = add_style(root, "paragraph", style.id, style.name, style.based_on);
  if (style.next != nullptr) add_value(node, "w:next", style.next);
  node.append_child("w:qFormat");
  xml_node paragraph = node.append_child("w:pPr");
  if (style.keeps_next) paragraph.append_child("w:keepNext");
  if (style.is_list) {
    xml_node list = paragraph.append_child("w:numPr");
    add_value(list, "w:numId", 1);
  }
  if (style.has_rule)
    add_border(paragraph.append_child("w:pBdr"), "w:bottom", kHairline_pt, kHairline);
  if (style.tab_mm > 0) {
    xml_node tab = paragraph.append_child("w:tabs").append_child("w:tab");
    set(tab, "w:val", "right");
    set(tab, "w:pos", twips_of_mm(style.tab_mm));
  }
  add_spacing(paragraph, style.text.before_pt, style.text.after_pt, style.text.line_spacing);
  if (style.outline_level >= 0) add_value(paragraph, "w:outlineLvl", style.outline_level);
  xml_node run = node.append_child("w:rPr");
  if (style.text.bold) {
    run.append_child("w:b");
    run.append_child("w:bCs");
  }
  add_value(run, "w:color", to_hex(style.text.color));
  for (const char* size : {"w:sz", "w:szCs"})
    add_value(run, size, std::lround(style.text.size_pt * 2));
}

xml_node add_table_style(xml_node root, const char* id, const char* name, double padding_mm) {
  xml_node node = add_style(root, "table", id, name, nullptr);
  xml_node margins = node.append_child("w:tblPr").append_child("w:tblCellMar");
  for (const char* side : {"w:left", "w:right"}) {
    xml_node margin = margins.append_child(side);
    set(margin, "w:w", twips_of_mm(padding_mm));
    set(margin, "w:type", "dxa");
  }
  return node;
}

void add_table_part(xml_node style, const char* part, const char* side) {
  xml_node node = style.append_child("w:tblStylePr");
  set(node, "w:type", part);
  add_border(node.append_child("w:tcPr").append_child("w:tcBorders"), side, kRule_pt, kRule);
}

}  // namespace

std::string docx_styles(const std::string& language) {
  pugi::xml_document xml;
  xml_node root = begin_xml(xml, "w:styles");
  set(root, "xmlns:w", "http://schemas.openxmlformats.org/wordprocessingml/2006/main");
  xml_node run =
      root.append_child("w:docDefaults").append_child("w:rPrDefault").append_child("w:rPr");
  xml_node fonts = run.append_child("w:rFonts");
  for (const char* script : {"w:ascii", "w:hAnsi", "w:eastAsia", "w:cs"}) set(fonts, script, kFont);
  xml_node tongue = run.append_child("w:lang");
  for (const char* script : {"w:val", "w:eastAsia", "w:bidi"}) set(tongue, script, language);

  set(add_style(root, "paragraph", "Normal", "Normal", nullptr), "w:default", 1);
  TextStyle gap{4, false, kInk, 1, 0, 0}, picture{10, false, kInk, 1, 0, 0},
      caption = kCaption, table_caption = kCaption;
  picture.before_pt = kAbovePicture_pt;
  picture.after_pt = kCaptionGap_pt;
  caption.after_pt = kBelowPicture_pt;
  table_caption.before_pt = kAboveTable_pt;
  table_caption.after_pt = kCaptionGap_pt;
  add(root, {"Title", "Title", kTitle, "BodyText"});
  add(root, {"Subtitle", "Subtitle", kSubject, "BodyText"});
  add(root, {"Heading1", "heading 1", kHeadings[0], "BodyText", 0, true});
  add(root, {"Heading2", "heading 2", kHeadings[1], "BodyText", 1, true});
  add(root, {"Heading3", "heading 3", kHeadings[2], "BodyText", 2, true});
  add(root, {"BodyText", "Body Text", kBody});
  add(root, {"ListBullet", "List Bullet", kListItem, nullptr, -1, false, true});
  add(root, {"Picture", "Picture", picture, "Caption"});
  add(root, {"Caption", "caption", caption, "BodyText"});
  add(root, {"TableCaption", "Table Caption", table_caption, "BodyText", -1, true, false, 0, false,
             "Caption"});
  add(root, {"TableHead", "Table Head", kTableHead});
  add(root, {"TableText", "Table Text", kTableText});
  add(root, {"TableTotal", "Table Total", kTableTotal});
  add(root, {"TableGap", "Table Gap", gap, "BodyText"});
  add(root, {"TitleLabel", "Title Label", kLabel});
  add(root, {"TitleValue", "Title Value", kValue});
  add(root, {"TitleRule", "Title Rule", gap, "BodyText", -1, false, false, 0, true});
  add(root, {"Logo", "Logo", picture});
  add(root, {"Header", "header", kHeaderText, nullptr, -1, false, false, kTextWidth_mm});
  add(root, {"Footer", "footer", kHeaderText, nullptr, -1, false, false, kTextWidth_mm});

  add_table_style(root, "PlainTable", "Plain Table", 0);
  xml_node table = add_table_style(root, "ReportTable", "Report Table", kCellPadding_mm);
  xml_node borders = table.child("w:tblPr").prepend_child("w:tblBorders");
  add_border(borders, "w:top", kRule_pt, kRule);
  add_border(borders, "w:bottom", kRule_pt, kRule);
  add_border(borders, "w:insideH", kHairline_pt, kHairline);
  add_table_part(table, "firstRow", "w:bottom");
  add_table_part(table, "lastRow", "w:top");
  return xml_text(xml);
}

}  // namespace strata::report
