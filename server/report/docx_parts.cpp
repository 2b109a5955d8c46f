#include "report/docx_parts.h"

#include <algorithm>
#include <cmath>

#include "core/text/hex.h"
#include "report/docx_styles.h"
#include "report/page.h"
#include "report/style.h"
#include "report/time_text.h"
#include "report/xml.h"

namespace strata::report {
namespace {

using pugi::xml_node;

constexpr const char* kMain = "http://schemas.openxmlformats.org/wordprocessingml/2006/main";
const std::string kWordTypes = "application/vnd.openxmlformats-officedocument.wordprocessingml.";
const std::string kRelationships =
    "http://schemas.openxmlformats.org/officeDocument/2006/relationships/";

DocxPart content_types() {
  pugi::xml_document xml;
  xml_node root = begin_xml(xml, "Types");
  set(root, "xmlns", "http://schemas.openxmlformats.org/package/2006/content-types");
  const std::pair<const char*, const char*> defaults[] = {
      {"rels", "application/vnd.openxmlformats-package.relationships+xml"},
      {"xml", "application/xml"},
      {"jpg", "image/jpeg"},
      {"png", "image/png"}};
  for (const auto& [extension, type] : defaults) {
    xml_node node = root.append_child("Default");
    set(node, "Extension", extension);
    set(node, "ContentType", type);
  }
  const std::pair<const char*, std::string> parts[] = {
      {"/word/document.xml", kWordTypes + "document.main+xml"},
      {"/word/styles.xml", kWordTypes + "styles+xml"},
      {"/word/settings.xml", kWordTypes + "settings+xml"},
      {"/word/numbering.xml", kWordTypes + "numbering+xml"},
      {"/word/header.xml", kWordTypes + "header+xml"},
      {"/word/footer.xml", kWordTypes + "footer+xml"},
      {"/docProps/core.xml", "application/vnd.openxmlformats-package.core-properties+xml"},
      {"/docProps/app.xml",
       "application/vnd.openxmlformats-officedocument.extended-properties+xml"}};
  for (const auto& [name, type] : parts) {
    xml_node node = root.append_child("Override");
    set(node, "PartName", name);
    set(node, "ContentType", type);
  }
  return {"[Content_Types].xml", xml_text(xml)};
}

class Relationships {
 public:
  Relationships() : root_(begin_xml(xml_, "Relationships")) {
    set(root_, "xmlns", "http://schemas.openxmlformats.org/package/2006/relationships");
  }
  void add(const std::string& id, const std::string& type, const std::string& target) {
    xml_node node = root_.append_child("Relationship");
    set(node, "Id", id);
    set(node, "Type", type);
    set(node, "Target", target);
  }
  std::string text() const { return xml_text(xml_); }

 private:
  pugi::xml_document xml_;
  xml_node root_;
};

DocxPart package_relationships() {
  Relationships all;
  all.add("document", kRelationships + "officeDocument", "word/document.xml");
  all.add("core",
          "http://schemas.openxmlformats.org/package/2006/relationships/metadata/core-properties",
          "docProps/core.xml");
  all.add("app", kRelationships + "extended-properties", "docProps/app.xml");
  return {"_rels/.rels", all.text()};
}

DocxPart document_relationships(const DocxBody& body) {
  Relationships all;
  for (const char* part : {"styles", "settings", "numbering"})
    all.add(part, kRelationships + part, std::string(part) + ".xml");
  all.add(kHeaderRelationship, kRelationships + "header", "header.xml");
  all.add(kFooterRelationship, kRelationships + "footer", "footer.xml");
  for (const DocxPicture& picture : body.pictures)
    all.add(picture.relationship, kRelationships + "image",
            picture.name.substr(std::string_view("word/").size()));
  return {"word/_rels/document.xml.rels", all.text()};
}

DocxPart core_properties(const Document& document) {
  pugi::xml_document xml;
  xml_node root = begin_xml(xml, "cp:coreProperties");
  set(root, "xmlns:cp", "http://schemas.openxmlformats.org/package/2006/metadata/core-properties");
  set(root, "xmlns:dc", "http://purl.org/dc/elements/1.1/");
  set(root, "xmlns:dcterms", "http://purl.org/dc/terms/");
  set(root, "xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance");
  add_text(root, "dc:title", document.title);
  add_text(root, "dc:subject", document.subject);
  add_text(root, "dc:creator", document.author);
  add_text(root, "cp:lastModifiedBy", document.author);
  add_text(root, "dc:language", document.language);
  for (const char* element : {"dcterms:created", "dcterms:modified"})
    set(add_text(root, element, time_text(document.created)), "xsi:type", "dcterms:W3CDTF");
  return {"docProps/core.xml", xml_text(xml)};
}

DocxPart app_properties() {
  pugi::xml_document xml;
  xml_node root = begin_xml(xml, "Properties");
  set(root, "xmlns", "http://schemas.openxmlformats.org/officeDocument/2006/extended-properties");
  add_text(root, "Application", "Strata");
  return {"docProps/app.xml", xml_text(xml)};
}

DocxPart settings(const Document& document) {
  pugi::xml_document xml;
  xml_node root = begin_xml(xml, "w:settings");
  set(root, "xmlns:w", kMain);
  // The layout of Word 2013 and later. Without it, Word opens the file in a compatibility mode.
  xml_node mode = root.append_child("w:compat").append_child("w:compatSetting");
  set(mode, "w:name", "compatibilityMode");
  set(mode, "w:uri", "http://schemas.microsoft.com/office/word");
  set(mode, "w:val", 15);
  add_value(root, "w:themeFontLang", document.language);
  return {"word/settings.xml", xml_text(xml)};
}

DocxPart numbering() {
  pugi::xml_document xml;
  xml_node root = begin_xml(xml, "w:numbering");
  set(root, "xmlns:w", kMain);
  xml_node list = root.append_child("w:abstractNum");
  set(list, "w:abstractNumId", 0);
  add_value(list, "w:multiLevelType", "singleLevel");
  xml_node level = list.append_child("w:lvl");
  set(level, "w:ilvl", 0);
  add_value(level, "w:start", 1);
  add_value(level, "w:numFmt", "bullet");
  add_value(level, "w:lvlText", "•");
  add_value(level, "w:lvlJc", "left");
  xml_node indent = level.append_child("w:pPr").append_child("w:ind");
  const long twips = std::lround(kListIndent_pt * 20);
  set(indent, "w:left", twips);
  set(indent, "w:hanging", twips);
  xml_node number = root.append_child("w:num");
  set(number, "w:numId", 1);
  add_value(number, "w:abstractNumId", 0);
  return {"word/numbering.xml", xml_text(xml)};
}

DocxPart header(const Document& document) {
  pugi::xml_document xml;
  xml_node root = begin_xml(xml, "w:hdr");
  set(root, "xmlns:w", kMain);
  xml_node paragraph = root.append_child("w:p");
  add_value(paragraph.append_child("w:pPr"), "w:pStyle", "Header");
  add_lines(paragraph.append_child("w:r"), document.header);
  return {"word/header.xml", xml_text(xml)};
}

// A field whose value the word processor computes.
void add_field(xml_node paragraph, const char* instruction) {
  xml_node field = paragraph.append_child("w:fldSimple");
  set(field, "w:instr", instruction);
  add_text(field.append_child("w:r"), "w:t", "1");
}

DocxPart footer(const Document& document) {
  pugi::xml_document xml;
  xml_node root = begin_xml(xml, "w:ftr");
  set(root, "xmlns:w", kMain);
  xml_node paragraph = root.append_child("w:p");
  add_value(paragraph.append_child("w:pPr"), "w:pStyle", "Footer");
  add_lines(paragraph.append_child("w:r"), document.footer);
  paragraph.append_child("w:r").append_child("w:tab");
  add_field(paragraph, "PAGE");
  set(add_text(paragraph.append_child("w:r"), "w:t", " / "), "xml:space", "preserve");
  add_field(paragraph, "NUMPAGES");
  return {"word/footer.xml", xml_text(xml)};
}

}  // namespace

std::vector<DocxPart> docx_parts(const Document& document, const DocxBody& body) {
  return {content_types(),
          package_relationships(),
          core_properties(document),
          app_properties(),
          {"word/document.xml", body.xml},
          document_relationships(body),
          {"word/styles.xml", docx_styles(document.language)},
          settings(document),
          numbering(),
          header(document),
          footer(document)};
}

}  // namespace strata::report
