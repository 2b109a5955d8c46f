#include "report/pdf_archive.h"

#include <cairo.h>
#include <lcms2.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <qpdf/QPDF.hh>
#include <qpdf/QPDFObjectHandle.hh>
#include <qpdf/QPDFWriter.hh>
#include <stdexcept>

#include "core/owned_file.h"
#include "report/time_text.h"
#include "report/unwritable.h"
#include "report/xml.h"

namespace strata::report {
namespace {

using Object = QPDFObjectHandle;
using pugi::xml_node;

constexpr const char* kCreator = "Strata";

std::string producer() {
  return "cairo " + std::string(cairo_version_string()) + ", QPDF " + QPDF::QPDFVersion();
}

void add_alternative(xml_node properties, const char* element, const std::string& text) {
  if (text.empty()) return;
  xml_node list = properties.append_child(element).append_child("rdf:Alt");
  set(add_text(list, "rdf:li", text), "xml:lang", "x-default");
}

void add_item(xml_node properties, const char* element, const char* list, const std::string& text) {
  if (text.empty()) return;
  add_text(properties.append_child(element).append_child(list), "rdf:li", text);
}

// Returns the metadata as XMP (ISO 16684-1). They equal those of `info` below (ISO 19005-2, section
// 6.6.3).
std::string xmp(const Document& document) {
  pugi::xml_document xml;
  const auto add_instruction = [&](const char* content) {
    xml_node node = xml.append_child(pugi::node_pi);
    node.set_name("xpacket");
    node.set_value(content);
  };
  add_instruction("begin=\"\uFEFF\" id=\"W5M0MpCehiHzreSzNTczkc9d\"");
  xml_node root = xml.append_child("x:xmpmeta");
  set(root, "xmlns:x", "adobe:ns:meta/");
  xml_node graph = root.append_child("rdf:RDF");
  set(graph, "xmlns:rdf", "http://www.w3.org/1999/02/22-rdf-syntax-ns#");
  xml_node properties = graph.append_child("rdf:Description");
  set(properties, "rdf:about", "");
  set(properties, "xmlns:dc", "http://purl.org/dc/elements/1.1/");
  set(properties, "xmlns:pdf", "http://ns.adobe.com/pdf/1.3/");
  set(properties, "xmlns:pdfaid", "http://www.aiim.org/pdfa/ns/id/");
  set(properties, "xmlns:xmp", "http://ns.adobe.com/xap/1.0/");
  add_text(properties, "pdfaid:part", "2");
  add_text(properties, "pdfaid:conformance", "B");
  add_alternative(properties, "dc:title", document.title);
  add_item(properties, "dc:creator", "rdf:Seq", document.author);
  add_alternative(properties, "dc:description", document.subject);
  add_item(properties, "dc:language", "rdf:Bag", document.language);
  add_text(properties, "xmp:CreatorTool", kCreator);
  add_text(properties, "xmp:CreateDate", time_text(document.created));
  add_text(properties, "xmp:ModifyDate", time_text(document.created));
  add_text(properties, "pdf:Producer", producer());
  add_instruction("end=\"w\"");
  return xml_text(xml);
}

Object info(const Document& document) {
  Object dictionary = Object::newDictionary();
  const auto add = [&](const char* key, const std::string& text) {
    if (!text.empty()) dictionary.replaceKey(key, Object::newUnicodeString(text));
  };
  add("/Title", document.title);
  add("/Author", document.author);
  add("/Subject", document.subject);
  add("/Creator", kCreator);
  add("/Producer", producer());
  // "2026-03-01T09:30:00Z" becomes "D:20260301093000Z".
  std::string time = "D:" + time_text(document.created);
  std::erase_if(time, [](char c) { return c == '-' || c == 'T'; });
  for (auto at = time.find(':', 2); at != std::string::npos; at = time.find(':', 2))
    time.erase(at, 1);
  add("/CreationDate", time);
  add("/ModDate", time);
  return dictionary;
}

struct CloseProfile {
  void operator()(void* profile) const { cmsCloseProfile(profile); }
};

// Returns the ICC profile of sRGB in version 2, which all versions of PDF/A allow.
std::string srgb_profile() {
  const std::unique_ptr<void, CloseProfile> profile(cmsCreate_sRGBProfile());
  if (!profile) throw std::runtime_error("the color profile was not made");
  cmsSetProfileVersion(profile.get(), 2.1);
  cmsUInt32Number size = 0;
  if (!cmsSaveProfileToMem(profile.get(), nullptr, &size))
    throw std::runtime_error("the color profile was not made");
  std::string bytes(size, '\0');
  if (!cmsSaveProfileToMem(profile.get(), bytes.data(), &size))
    throw std::runtime_error("the color profile was not made");
  // Little CMS writes the current time into the header (ICC.1:2001-04, section 6.1.3). A fixed time
  // makes the file depend only on the document: 2000-01-01 0:00.
  constexpr std::size_t kTime = 24;
  constexpr std::array<char, 12> k2000{0x07, static_cast<char>(0xd0), 0, 1, 0, 1};
  std::copy(k2000.begin(), k2000.end(), bytes.begin() + kTime);
  return bytes;
}

Object output_intent(QPDF& pdf) {
  Object profile = pdf.newStream(srgb_profile());
  profile.getDict().replaceKey("/N", Object::newInteger(3));
  Object intent = Object::newDictionary();
  intent.replaceKey("/Type", Object::newName("/OutputIntent"));
  intent.replaceKey("/S", Object::newName("/GTS_PDFA1"));
  intent.replaceKey("/OutputConditionIdentifier", Object::newString("sRGB IEC61966-2.1"));
  intent.replaceKey("/Info", Object::newString("sRGB IEC61966-2.1"));
  intent.replaceKey("/RegistryName", Object::newString("http://www.color.org"));
  intent.replaceKey("/DestOutputProfile", profile);
  return pdf.makeIndirectObject(intent);
}

Object metadata(QPDF& pdf, const Document& document) {
  Object stream = pdf.newStream(xmp(document));
  stream.getDict().replaceKey("/Type", Object::newName("/Metadata"));
  stream.getDict().replaceKey("/Subtype", Object::newName("/XML"));
  // Readers of archives find metadata without a filter.
  stream.setFilterOnWrite(false);
  return stream;
}

// Adds the texts to the elements `Figure` of the structure below `element`, in their order.
void add_alternatives(Object element, const std::vector<std::string>& alternatives,
                      std::size_t& next) {
  if (element.isArray()) {
    for (const Object& child : element.aitems()) add_alternatives(child, alternatives, next);
    return;
  }
  if (!element.isDictionary()) return;  // the number of a part of a page
  if (element.getKey("/S").isNameAndEquals("/Figure") && next < alternatives.size()) {
    const std::string& text = alternatives[next++];
    if (!text.empty()) element.replaceKey("/Alt", Object::newUnicodeString(text));
  }
  if (element.hasKey("/K")) add_alternatives(element.getKey("/K"), alternatives, next);
}

// Corrects what PDF/A forbids: fonts without a map of their glyphs (ISO 19005-2,
// section 6.2.11.3.2) and interpolated images (section 6.2.8), which cairo writes for colored
// letters.
void mend_objects(QPDF& pdf) {
  for (Object object : pdf.getAllObjects()) {
    if (object.isDictionaryOfType("/Font", "/CIDFontType2") && !object.hasKey("/CIDToGIDMap"))
      object.replaceKey("/CIDToGIDMap", Object::newName("/Identity"));
    if (!object.isStream()) continue;
    Object dictionary = object.getDict();
    if (dictionary.hasKey("/Interpolate"))
      dictionary.replaceKey("/Interpolate", Object::newBool(false));
  }
}

}  // namespace

Result<void> write_archive(const std::filesystem::path& drawn, const std::filesystem::path& file,
                           const Document& document, const std::vector<std::string>& alternatives) {
  QPDF pdf;
  // cairo names a picture twice if it is twice on a page. QPDF would print a warning.
  pdf.setSuppressWarnings(true);
  pdf.processFile(drawn.c_str());
  mend_objects(pdf);
  Object root = pdf.getRoot();
  std::size_t next = 0;
  add_alternatives(root.getKey("/StructTreeRoot"), alternatives, next);
  root.replaceKey("/Lang", Object::newUnicodeString(document.language));
  root.replaceKey("/Metadata", metadata(pdf, document));
  root.replaceKey("/OutputIntents", Object::newArray({output_intent(pdf)}));
  if (!document.title.empty()) {
    Object preferences = Object::newDictionary();
    preferences.replaceKey("/DisplayDocTitle", Object::newBool(true));
    root.replaceKey("/ViewerPreferences", preferences);
  }
  pdf.getTrailer().replaceKey("/Info", pdf.makeIndirectObject(info(document)));

  // QPDF ignores errors of its own files when it closes them, for example on a full disk.
  OwnedFile output(std::fopen(file.c_str(), "wb"));
  if (!output) return unwritable();
  QPDFWriter writer(pdf);
  writer.setOutputFile(file.c_str(), output.get(), false);
  writer.setMinimumPDFVersion("1.7");  // the version of PDF/A-2
  writer.setObjectStreamMode(qpdf_o_generate);
  writer.setNewlineBeforeEndstream(true);
  writer.setDeterministicID(true);
  try {
    writer.write();
  } catch (const std::exception&) {
    if (std::ferror(output.get()) != 0) return unwritable();
    throw;
  }
  const bool has_error = std::ferror(output.get()) != 0;
  if (std::fclose(output.release()) != 0 || has_error) return unwritable();
  return {};
}

}  // namespace strata::report
