// Reference: Autodesk, DXF Reference, AutoCAD 2007.
#include "figure/write_dxf.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <tuple>
#include <unordered_map>

#include "core/text/printable.h"
#include "core/text/search_text.h"
#include "core/text/utf8.h"
#include "figure/pattern.h"
#include "figure/writers.h"

namespace strata::figure {
namespace {

constexpr std::size_t kMaxName = 200;    // of a DXF layer, in bytes
constexpr std::size_t kMaxString = 255;  // of extended data, in bytes
constexpr int kWhite = 7;                // color number, black on a white background
// The handles of objects to which others refer. Other objects have handles from kFirstFree on.
enum Handle : unsigned {
  kBlockTable = 1,
  kLayerTable,
  kStyleTable,
  kLinetypeTable,
  kViewTable,
  kUcsTable,
  kViewportTable,
  kApplicationTable,
  kDimensionTable,
  kModelSpace,
  kPaperSpace,
  kRootDictionary,
  kGroupDictionary,
  kLayoutDictionary,
  kPlotStyleDictionary,
  kPlotStyle,
  kModelLayout,
  kPaperLayout,
  kFirstBlock,  // four objects
  kFirstFree = 0x30
};

// Writes pairs of a group code and a value.
class Pairs {
 public:
  explicit Pairs(std::ostream& out) : out_(out) {}

  void text(int code, std::string_view value) { out_ << code << '\n' << value << '\n'; }
  void whole(int code, std::int64_t value) { out_ << code << '\n' << value << '\n'; }
  // Ten-thousandths of a millimeter are enough for drawings.
  void number(int code, double value) {
    std::array<char, 400> digits{};
    const double rounded = std::round(value * 1e4) / 1e4 + 0.0;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), rounded,
                                   std::chars_format::fixed);
    text(code, {digits.data(), static_cast<std::size_t>(end.ptr - digits.data())});
  }
  void handle(int code, unsigned value) {
    std::array<char, 16> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value, 16);
    std::transform(digits.data(), end.ptr, digits.data(),
                   [](char c) { return c >= 'a' ? static_cast<char>(c - 'a' + 'A') : c; });
    text(code, {digits.data(), static_cast<std::size_t>(end.ptr - digits.data())});
  }
  void point(int code, const glm::dvec2& at) {
    number(code, at.x);
    number(code + 10, at.y);
  }
  void space_point(int code, const glm::dvec2& at) {
    point(code, at);
    number(code + 20, 0);
  }

 private:
  std::ostream& out_;
};

// Returns a text for a string of a DXF file. ^ begins the code of a control character there.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : printable(text)) {
    if (c == '^')
      out += "^ ";
    else
      out += c == '\n' || c == '\t' ? ' ' : c;
  }
  return out;
}

// In the text of a drawing, %% begins the code of a special character, and %%% is a percent sign.
std::string drawn_text(const std::string& text) {
  std::string out = plain(text);
  for (std::size_t at = out.find("%%"); at != std::string::npos; at = out.find("%%", at + 6))
    out.replace(at, 2, "%%%%%%");
  return out;
}

std::int64_t true_color(const Rgba& color) {
  return std::int64_t{color[0]} << 16 | std::int64_t{color[1]} << 8 | color[2];
}

double area_of(const OutlinePolygon& polygon) {
  double area = 0;
  for (std::size_t i = 0; i < polygon.rings.size(); ++i)
    area += (i == 0 ? 1 : -1) * std::abs(signed_area(polygon.rings[i]));
  return area;
}

// The names of DXF layers: without forbidden characters, and unique regardless of case.
class LayerNames {
 public:
  std::string add(const std::string& wanted) {
    std::string name;
    for (const char c : plain(wanted))
      name += std::string_view("<>/\\\":;?*|=,`^").find(c) == std::string_view::npos ? c : '_';
    name = first_bytes(name, kMaxName);
    std::string unique = name;
    int& number = numbers_[case_folded(name)];
    while (!known_.insert(case_folded(unique)).second)
      unique = name + " " + std::to_string(++number + 1);
    return unique;
  }

 private:
  std::set<std::string> known_{"0"};
  std::unordered_map<std::string, int> numbers_;  // the last one, by folded name
};

struct DxfLayer {
  std::string name;
  std::optional<Rgba> color;  // nullopt: black or white
};

// What the header states about the rest of the file.
struct Facts {
  unsigned next_handle = kFirstFree;
  glm::dvec2 low{std::numeric_limits<double>::max()};  // of all points
  glm::dvec2 high{std::numeric_limits<double>::lowest()};
};

class DxfWriter {
 public:
  DxfWriter(const DxfDrawing& drawing, const Progress& progress, std::ostream& out)
      : drawing_(drawing), progress_(progress), pairs_(out) {
    LayerNames names;
    for (const LayerVectors& layer : drawing.areas)
      for (const ClassArea& area : layer.areas)
        layers_.push_back({names.add(layer.name + " - " + area.name), area.color});
    for (const LayerVectors& layer : drawing.marks)
      if (!layer.marks.empty()) layers_.push_back({names.add(layer.name), std::nullopt});
    if (!drawing.labels.empty()) layers_.push_back({names.add("Labels"), std::nullopt});
    if (!drawing.dimensions.empty()) layers_.push_back({names.add("Dimensions"), std::nullopt});
  }

  // Returns the facts of the written file.
  Result<Facts> write(const Facts& stated) {
    write_header(stated);
    write_classes();
    write_tables(stated);
    write_blocks();
    begin_section("ENTITIES");
    STRATA_TRY(write_entities());
    pairs_.text(0, "ENDSEC");
    write_objects();
    pairs_.text(0, "EOF");
    return facts_;
  }

 private:
  unsigned new_handle() { return facts_.next_handle++; }
  glm::dvec2 on_object(const glm::dvec2& on_sheet) const {
    const glm::dvec2 from_corner = (on_sheet - drawing_.area.corner) * drawing_.scale;
    return drawing_.top_left + glm::dvec2(from_corner.x, -from_corner.y);
  }

  // ── entities ──────────

  Result<void> write_entities() {
    auto layer_of_file = layers_.begin();
    for (const LayerVectors& layer : drawing_.areas)
      for (const ClassArea& area : layer.areas)
        STRATA_TRY(add_class((layer_of_file++)->name, layer, area));
    for (const LayerVectors& layer : drawing_.marks)
      if (!layer.marks.empty()) STRATA_TRY(add_marks((layer_of_file++)->name, layer));
    if (!drawing_.labels.empty()) add_labels((layer_of_file++)->name);
    if (!drawing_.dimensions.empty()) add_dimensions(layer_of_file->name);
    return {};
  }

  // What an entity has instead of the properties of its layer.
  struct Ink {
    std::optional<Rgba> color{};
    double opacity = 1;
  };
  void begin_entity(const char* type, const std::string& layer, const Ink& ink) {
    pairs_.text(0, type);
    pairs_.handle(5, new_handle());
    pairs_.handle(330, kModelSpace);
    pairs_.text(100, "AcDbEntity");
    pairs_.text(8, layer);
    if (ink.color) pairs_.whole(420, true_color(*ink.color));
    if (ink.opacity < 1) pairs_.whole(440, 0x02000000 | std::lround(255 * ink.opacity));
  }

  void polyline(const std::string& layer, const OutlineRing& ring, bool is_closed, const Ink& ink) {
    begin_entity("LWPOLYLINE", layer, ink);
    pairs_.text(100, "AcDbPolyline");
    pairs_.whole(90, static_cast<std::int64_t>(ring.size()));
    pairs_.whole(70, is_closed ? 1 : 0);
    for (const glm::dvec2& point : ring) add_point(10, point);
  }
  void add_point(int code, const glm::dvec2& on_sheet) {
    const glm::dvec2 at = on_object(on_sheet);
    pairs_.point(code, at);
    facts_.low = glm::min(facts_.low, at);
    facts_.high = glm::max(facts_.high, at);
  }

  void attributes(const LayerVectors& layer, const std::string& name, double value,
                  std::optional<double> area_mm2) {
    pairs_.text(1001, "STRATA");
    const auto pair = [&](const char* key, const std::string& text) {
      pairs_.text(1000, key);
      pairs_.text(1000, first_bytes(plain(text), kMaxString));
    };
    pair("layer", layer.name);
    if (!name.empty()) pair("class", name);
    pairs_.text(1000, "value");
    pairs_.number(1040, value);
    if (!area_mm2) return;
    pairs_.text(1000, "area_mm2");
    pairs_.number(1040, *area_mm2);
  }
  Result<void> add_class(const std::string& name, const LayerVectors& layer,
                         const ClassArea& area) {
    const double shown = layer.opacity * area.color[3] / 255.0;
    for (const OutlinePolygon& polygon : area.polygons) {
      if (progress_.cancelled()) return cancelled_problem();
      const double area_mm2 = area_of(polygon) * drawing_.scale * drawing_.scale;
      if (area.pattern != Pattern::outline) {
        hatch(name, polygon, area, shown);
        attributes(layer, area.name, area.value, area_mm2);
      }
      for (const OutlineRing& ring : polygon.rings) {
        polyline(name, ring, true, {});
        attributes(layer, area.name, area.value, area_mm2);
      }
    }
    return {};
  }

  void hatch(const std::string& name, const OutlinePolygon& polygon, const ClassArea& area,
             double shown) {
    constexpr int kExternal = 1, kPolyline = 2, kOutermost = 16;
    const bool is_solid = area.pattern == Pattern::solid;
    begin_entity("HATCH", name, {std::nullopt, shown});
    pairs_.text(100, "AcDbHatch");
    pairs_.space_point(10, {0, 0});
    pairs_.number(210, 0);
    pairs_.number(220, 0);
    pairs_.number(230, 1);
    pairs_.text(2, is_solid ? "SOLID" : area.pattern == Pattern::dots ? "DOTS" : "LINES");
    pairs_.whole(70, is_solid ? 1 : 0);
    pairs_.whole(71, 0);
    pairs_.whole(91, static_cast<std::int64_t>(polygon.rings.size()));
    for (std::size_t i = 0; i < polygon.rings.size(); ++i) {
      pairs_.whole(92, kPolyline | (i == 0 ? kExternal : kOutermost));
      pairs_.whole(72, 0);
      pairs_.whole(73, 1);
      pairs_.whole(93, static_cast<std::int64_t>(polygon.rings[i].size()));
      for (const glm::dvec2& point : polygon.rings[i]) add_point(10, point);
      pairs_.whole(97, 0);
    }
    pairs_.whole(75, 0);
    pairs_.whole(76, is_solid ? 1 : 2);
    if (!is_solid) {
      const double spacing = area.spacing_mm * drawing_.scale;
      const glm::dvec2 along = direction(area.angle);
      const glm::dvec2 across(along.y, along.x);  // y up on the object
      pairs_.number(52, 0);
      pairs_.number(41, 1);
      pairs_.whole(77, 0);
      pairs_.whole(78, 1);
      pairs_.number(53, area.angle);
      pairs_.number(43, 0);
      pairs_.number(44, 0);
      pairs_.number(45, across.x * spacing);
      pairs_.number(46, across.y * spacing);
      if (area.pattern == Pattern::dots) {
        pairs_.whole(79, 2);
        pairs_.number(49, 0);
        pairs_.number(49, -spacing);
      } else {
        pairs_.whole(79, 0);
      }
    }
    pairs_.whole(98, 0);
  }

  Result<void> add_marks(const std::string& name, const LayerVectors& layer) {
    for (const RecordMark& mark : layer.marks) {
      if (progress_.cancelled()) return cancelled_problem();
      const Ink ink{mark.color, layer.opacity * mark.color[3] / 255.0};
      if (mark.points.size() > 1) {
        polyline(name, mark.points, false, ink);
      } else {
        begin_entity("POINT", name, ink);
        pairs_.text(100, "AcDbPoint");
        add_point(10, mark.points[0]);
        pairs_.number(30, 0);
      }
      attributes(layer, mark.name, static_cast<double>(mark.key), std::nullopt);
    }
    return {};
  }

  void add_labels(const std::string& name) {
    for (const Label& label : drawing_.labels) {
      begin_entity("TEXT", name, {});
      pairs_.text(100, "AcDbText");
      add_point(10, drawing_.area.corner + label.at);
      pairs_.number(30, 0);
      pairs_.number(40, kLabel_mm * drawing_.scale);
      pairs_.text(1, drawn_text(label.text));
      pairs_.whole(72, 1);  // centered
      add_point(11, drawing_.area.corner + label.at);
      pairs_.number(31, 0);
      pairs_.text(100, "AcDbText");
      pairs_.whole(73, 2);  // at half height
    }
  }

  // Lines and texts, because a DIMENSION would need a block with the same lines and texts.
  void add_dimensions(const std::string& name) {
    for (const Dimension& dimension : drawing_.dimensions) {
      for (const auto& [from, to] : dimension.lines) polyline(name, {from, to}, false, {});
      for (const auto& [from, to] : dimension.ticks) polyline(name, {from, to}, false, {});
      begin_entity("TEXT", name, {});
      pairs_.text(100, "AcDbText");
      add_point(10, dimension.at);
      pairs_.number(30, 0);
      pairs_.number(40, kDimensionText_mm * drawing_.scale);
      pairs_.text(1, drawn_text(dimension.text));
      pairs_.number(50, dimension.angle);
      pairs_.whole(72, 1);  // centered
      add_point(11, dimension.at);
      pairs_.number(31, 0);
      pairs_.text(100, "AcDbText");
      pairs_.whole(73, 0);  // on the baseline
    }
  }

  // ── sections ──────────

  void begin_section(const char* name) {
    pairs_.text(0, "SECTION");
    pairs_.text(2, name);
  }

  void write_header(const Facts& stated) {
    begin_section("HEADER");
    const auto name = [&](const char* variable) { pairs_.text(9, variable); };
    name("$ACADVER");
    pairs_.text(1, "AC1021");
    name("$DWGCODEPAGE");
    pairs_.text(3, "ANSI_1252");  // texts are UTF-8 since AC1021
    name("$INSUNITS");
    pairs_.whole(70, 4);  // millimeters
    name("$MEASUREMENT");
    pairs_.whole(70, 1);  // metric
    name("$HANDSEED");
    pairs_.handle(5, stated.next_handle);
    const bool has_content = stated.low.x <= stated.high.x;
    name("$EXTMIN");
    pairs_.space_point(10, has_content ? stated.low : glm::dvec2(0));
    name("$EXTMAX");
    pairs_.space_point(10, has_content ? stated.high : glm::dvec2(0));
    pairs_.text(0, "ENDSEC");
  }

  // Classes of objects that are not in every DXF file.
  void write_classes() {
    begin_section("CLASSES");
    for (const auto& [type, name] :
         {std::pair("ACDBDICTIONARYWDFLT", "AcDbDictionaryWithDefault"),
          std::pair("ACDBPLACEHOLDER", "AcDbPlaceHolder"), std::pair("LAYOUT", "AcDbLayout")}) {
      pairs_.text(0, "CLASS");
      pairs_.text(1, type);
      pairs_.text(2, name);
      pairs_.text(3, "ObjectDBX Classes");
      for (const int code : {90, 91, 280, 281}) pairs_.whole(code, 0);
    }
    pairs_.text(0, "ENDSEC");
  }

  void begin_table(const char* name, unsigned handle, std::size_t entries) {
    pairs_.text(0, "TABLE");
    pairs_.text(2, name);
    pairs_.handle(5, handle);
    pairs_.whole(330, 0);
    pairs_.text(100, "AcDbSymbolTable");
    pairs_.whole(70, static_cast<std::int64_t>(entries));
  }
  void begin_record(const char* type, unsigned table, const char* subclass) {
    pairs_.text(0, type);
    pairs_.handle(5, new_handle());
    pairs_.handle(330, table);
    pairs_.text(100, "AcDbSymbolTableRecord");
    pairs_.text(100, subclass);
  }

  void write_layer(const DxfLayer& layer) {
    begin_record("LAYER", kLayerTable, "AcDbLayerTableRecord");
    pairs_.text(2, layer.name);
    pairs_.whole(70, 0);
    pairs_.whole(62, kWhite);
    if (layer.color) pairs_.whole(420, true_color(*layer.color));
    pairs_.text(6, "Continuous");
    pairs_.whole(370, -3);  // the default width of lines
    pairs_.handle(390, kPlotStyle);
  }

  // A window that shows all content.
  void write_viewport(const Facts& stated) {
    const bool has_content = stated.low.x <= stated.high.x;
    const glm::dvec2 size = has_content ? stated.high - stated.low : glm::dvec2(1);
    begin_record("VPORT", kViewportTable, "AcDbViewportTableRecord");
    pairs_.text(2, "*Active");
    pairs_.whole(70, 0);
    pairs_.point(10, {0, 0});
    pairs_.point(11, {1, 1});
    pairs_.point(12, has_content ? (stated.low + stated.high) / 2.0 : glm::dvec2(0));
    for (const int code : {13, 14, 15}) pairs_.point(code, glm::dvec2(code == 13 ? 0 : 10));
    pairs_.point(16, {0, 0});  // from above
    pairs_.number(36, 1);
    pairs_.space_point(17, {0, 0});
    pairs_.number(40, std::max({size.x, size.y, 1.0}) * 1.1);  // height
    pairs_.number(41, 1);                                      // width / height
    pairs_.number(42, 50);
    for (const int code : {43, 44, 50, 51}) pairs_.number(code, 0);
    pairs_.whole(71, 0);
    pairs_.whole(72, 1000);
    pairs_.whole(73, 1);
    pairs_.whole(74, 3);
    for (const int code : {75, 76, 77, 78, 281, 65}) pairs_.whole(code, 0);
  }

  void write_tables(const Facts& stated) {
    begin_section("TABLES");
    const auto end = [&] { pairs_.text(0, "ENDTAB"); };
    begin_table("VPORT", kViewportTable, 1);
    write_viewport(stated);
    end();
    begin_table("LTYPE", kLinetypeTable, 3);
    for (const char* name : {"ByBlock", "ByLayer", "Continuous"}) {
      begin_record("LTYPE", kLinetypeTable, "AcDbLinetypeTableRecord");
      pairs_.text(2, name);
      pairs_.whole(70, 0);
      pairs_.text(3, "");
      pairs_.whole(72, 65);
      pairs_.whole(73, 0);
      pairs_.number(40, 0);
    }
    end();
    begin_table("LAYER", kLayerTable, layers_.size() + 1);
    write_layer({"0", std::nullopt});
    for (const DxfLayer& layer : layers_) write_layer(layer);
    end();
    begin_table("STYLE", kStyleTable, 1);
    begin_record("STYLE", kStyleTable, "AcDbTextStyleTableRecord");
    pairs_.text(2, "Standard");
    pairs_.whole(70, 0);
    pairs_.number(40, 0);
    pairs_.number(41, 1);
    pairs_.number(50, 0);
    pairs_.whole(71, 0);
    pairs_.number(42, kLabel_mm);
    pairs_.text(3, "arial.ttf");  // has letters of more languages than the fonts of AutoCAD
    pairs_.text(4, "");
    end();
    begin_table("VIEW", kViewTable, 0);
    end();
    begin_table("UCS", kUcsTable, 0);
    end();
    begin_table("APPID", kApplicationTable, 2);
    for (const char* name : {"ACAD", "STRATA"}) {
      begin_record("APPID", kApplicationTable, "AcDbRegAppTableRecord");
      pairs_.text(2, name);
      pairs_.whole(70, 0);
    }
    end();
    begin_table("DIMSTYLE", kDimensionTable, 1);
    pairs_.text(100, "AcDbDimStyleTable");
    pairs_.text(0, "DIMSTYLE");
    pairs_.handle(105, new_handle());
    pairs_.handle(330, kDimensionTable);
    pairs_.text(100, "AcDbSymbolTableRecord");
    pairs_.text(100, "AcDbDimStyleTableRecord");
    pairs_.text(2, "Standard");
    pairs_.whole(70, 0);
    end();
    begin_table("BLOCK_RECORD", kBlockTable, 2);
    for (const auto& [name, handle, layout] :
         {std::tuple("*Model_Space", kModelSpace, kModelLayout),
          std::tuple("*Paper_Space", kPaperSpace, kPaperLayout)}) {
      pairs_.text(0, "BLOCK_RECORD");
      pairs_.handle(5, handle);
      pairs_.handle(330, kBlockTable);
      pairs_.text(100, "AcDbSymbolTableRecord");
      pairs_.text(100, "AcDbBlockTableRecord");
      pairs_.text(2, name);
      pairs_.handle(340, layout);
      pairs_.whole(70, 0);
      pairs_.whole(280, 1);
      pairs_.whole(281, 0);
    }
    end();
    pairs_.text(0, "ENDSEC");
  }

  void write_blocks() {
    begin_section("BLOCKS");
    unsigned handle = kFirstBlock;
    for (const auto& [name, record] :
         {std::pair("*Model_Space", kModelSpace), std::pair("*Paper_Space", kPaperSpace)}) {
      const auto begin = [&, record = record](const char* type, const char* subclass) {
        pairs_.text(0, type);
        pairs_.handle(5, handle++);
        pairs_.handle(330, record);
        pairs_.text(100, "AcDbEntity");
        pairs_.text(8, "0");
        pairs_.text(100, subclass);
      };
      begin("BLOCK", "AcDbBlockBegin");
      pairs_.text(2, name);
      pairs_.whole(70, 0);
      pairs_.space_point(10, {0, 0});
      pairs_.text(3, name);
      pairs_.text(1, "");
      begin("ENDBLK", "AcDbBlockEnd");
    }
    pairs_.text(0, "ENDSEC");
  }

  void write_objects() {
    begin_section("OBJECTS");
    const auto dictionary = [&](const char* type, unsigned handle, unsigned owner,
                                std::initializer_list<std::pair<const char*, unsigned>> entries) {
      pairs_.text(0, type);
      pairs_.handle(5, handle);
      pairs_.handle(330, owner);
      pairs_.text(100, "AcDbDictionary");
      pairs_.whole(281, 1);
      for (const auto& [name, entry] : entries) {
        pairs_.text(3, name);
        pairs_.handle(350, entry);
      }
    };
    dictionary("DICTIONARY", kRootDictionary, 0,
               {{"ACAD_GROUP", kGroupDictionary},
                {"ACAD_LAYOUT", kLayoutDictionary},
                {"ACAD_PLOTSTYLENAME", kPlotStyleDictionary}});
    dictionary("DICTIONARY", kGroupDictionary, kRootDictionary, {});
    dictionary("DICTIONARY", kLayoutDictionary, kRootDictionary,
               {{"Model", kModelLayout}, {"Layout1", kPaperLayout}});
    dictionary("ACDBDICTIONARYWDFLT", kPlotStyleDictionary, kRootDictionary,
               {{"Normal", kPlotStyle}});
    pairs_.text(100, "AcDbDictionaryWithDefault");
    pairs_.handle(340, kPlotStyle);
    pairs_.text(0, "ACDBPLACEHOLDER");
    pairs_.handle(5, kPlotStyle);
    pairs_.handle(330, kPlotStyleDictionary);
    write_layout("Model", kModelLayout, kModelSpace, 0);
    write_layout("Layout1", kPaperLayout, kPaperSpace, 1);
    pairs_.text(0, "ENDSEC");
  }

  // A layout without content of its own, on A4.
  void write_layout(const char* name, unsigned handle, unsigned block, int order) {
    constexpr int kIsModel = 1024;
    const glm::dvec2 paper(297, 210);
    pairs_.text(0, "LAYOUT");
    pairs_.handle(5, handle);
    pairs_.handle(330, kLayoutDictionary);
    pairs_.text(100, "AcDbPlotSettings");
    pairs_.text(1, "");
    pairs_.text(2, "none_device");
    pairs_.text(4, "A4");
    pairs_.text(6, "");
    for (const int code : {40, 41, 42, 43}) pairs_.number(code, 0);
    pairs_.number(44, paper.x);
    pairs_.number(45, paper.y);
    for (const int code : {46, 47, 48, 49, 140, 141}) pairs_.number(code, 0);
    pairs_.number(142, 1);
    pairs_.number(143, 1);
    pairs_.whole(70, order == 0 ? kIsModel : 0);
    pairs_.whole(72, 1);  // millimeters
    pairs_.whole(73, 0);
    pairs_.whole(74, 5);
    pairs_.text(7, "");
    pairs_.whole(75, 16);
    pairs_.whole(76, 0);
    pairs_.whole(77, 2);
    pairs_.whole(78, 300);
    pairs_.number(147, 1);
    pairs_.number(148, 0);
    pairs_.number(149, 0);
    pairs_.text(100, "AcDbLayout");
    pairs_.text(1, name);
    pairs_.whole(70, 1);
    pairs_.whole(71, order);
    pairs_.point(10, {0, 0});
    pairs_.point(11, paper);
    pairs_.space_point(12, {0, 0});
    pairs_.space_point(14, {0, 0});
    pairs_.space_point(15, paper);
    pairs_.number(146, 0);
    pairs_.space_point(13, {0, 0});
    pairs_.space_point(16, {1, 0});
    pairs_.space_point(17, {0, 1});
    pairs_.whole(76, 0);
    pairs_.handle(330, block);
  }

  const DxfDrawing& drawing_;
  const Progress& progress_;
  Pairs pairs_;
  std::vector<DxfLayer> layers_;
  Facts facts_;
};

}  // namespace

Result<void> write_dxf(const DxfDrawing& drawing, const std::filesystem::path& file,
                       const Progress& progress) {
  // The header states the next handle and the extent, so the first run only finds these.
  std::ostream nowhere(nullptr);
  const Facts facts = STRATA_TRY(DxfWriter(drawing, progress, nowhere).write({}));
  std::ofstream out(file, std::ios::binary);
  STRATA_TRY(DxfWriter(drawing, progress, out).write(facts));
  out.close();
  if (!out) return unwritable();
  return {};
}

}  // namespace strata::figure
