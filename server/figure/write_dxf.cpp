// Reference: Autodesk, DXF Reference, AutoCAD 2007.
#include "figure/write_dxf.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "core/text/printable.h"
#include "figure/pattern.h"
#include "figure/writers.h"

namespace strata::figure {
namespace {

constexpr std::size_t kMaxName = 200;  // of a DXF layer, in bytes
constexpr int kWhite = 7;              // color number, black on a white background
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
  for (std::size_t k = 0; k < polygon.rings.size(); ++k) {
    const OutlineRing& ring = polygon.rings[k];
    double twice = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const glm::dvec2 a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
      twice += a.x * b.y - b.x * a.y;
    }
    area += (k == 0 ? 1 : -1) * std::abs(twice / 2);
  }
  return area;
}

// The names of DXF layers: without forbidden characters, and unique regardless of case.
class LayerNames {
 public:
  std::string add(const std::string& wanted) {
    std::string name;
    for (const char c : plain(wanted))
      name += std::string_view("<>/\\\":;?*|=,`^").find(c) == std::string_view::npos ? c : '_';
    if (name.size() > kMaxName) {
      name.resize(kMaxName);
      // not in the middle of a character
      while (!name.empty() && (static_cast<unsigned char>(name.back()) & 0xc0) == 0x80)
        name.pop_back();
      if (!name.empty() && static_cast<unsigned char>(name.back()) >= 0xc0) name.pop_back();
    }
    std::string unique = name;
    for (int number = 2; !known_.insert(folded(unique)).second; ++number)
      unique = name + " " + std::to_string(number);
    return unique;
  }

 private:
  static std::string folded(std::string name) {
    for (char& c : name)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return name;
  }
  std::set<std::string> known_{"0"};
};

struct DxfLayer {
  std::string name;
  std::optional<Rgba> color;  // nullopt: black or white
};

class DxfWriter {
 public:
  DxfWriter(const DxfDrawing& drawing, const Progress& progress)
      : drawing_(drawing), progress_(progress), entities_(entity_text_) {}

  Result<void> write(const std::filesystem::path& path) {
    for (const LayerVectors& layer : drawing_.areas)
      for (const ClassArea& area : layer.areas) STRATA_TRY(add_class(layer, area));
    for (const LayerVectors& layer : drawing_.marks)
      if (!layer.marks.empty()) add_marks(layer);
    if (!drawing_.labels.empty()) add_labels();
    std::ofstream out(path, std::ios::binary);
    Pairs pairs(out);
    // All handles are known only now, but the header states the next one.
    std::ostringstream tables;
    Pairs table_pairs(tables);
    write_tables(table_pairs);
    write_header(pairs);
    out << tables.str();
    write_blocks(pairs);
    begin_section(pairs, "ENTITIES");
    out << entity_text_.str();
    pairs.text(0, "ENDSEC");
    write_objects(pairs);
    pairs.text(0, "EOF");
    out.close();
    if (!out) return unwritable();
    return {};
  }

 private:
  unsigned new_handle() { return next_++; }
  glm::dvec2 on_object(const glm::dvec2& on_sheet) const {
    const glm::dvec2 from_corner = (on_sheet - drawing_.area.corner) * drawing_.scale;
    return drawing_.top_left + glm::dvec2(from_corner.x, -from_corner.y);
  }

  // ── entities ───────────────────────────────────────────────────────────────────────────────────

  unsigned begin_entity(const char* type, const std::string& layer) {
    const unsigned handle = new_handle();
    entities_.text(0, type);
    entities_.handle(5, handle);
    entities_.handle(330, kModelSpace);
    entities_.text(100, "AcDbEntity");
    entities_.text(8, layer);
    return handle;
  }
  void opacity(double value) {
    if (value < 1) entities_.whole(440, 0x02000000 | std::lround(255 * value));
  }

  void polyline(const std::string& layer, const OutlineRing& ring, bool is_closed) {
    begin_entity("LWPOLYLINE", layer);
    entities_.text(100, "AcDbPolyline");
    entities_.whole(90, static_cast<std::int64_t>(ring.size()));
    entities_.whole(70, is_closed ? 1 : 0);
    for (const glm::dvec2& point : ring) add_point(10, point);
  }
  void add_point(int code, const glm::dvec2& on_sheet) {
    const glm::dvec2 at = on_object(on_sheet);
    entities_.point(code, at);
    low_ = glm::min(low_, at);
    high_ = glm::max(high_, at);
  }

  void attributes(const LayerVectors& layer, const std::string& name, double value,
                  std::optional<double> area_mm2) {
    entities_.text(1001, "STRATA");
    const auto pair = [&](const char* key, const std::string& text) {
      entities_.text(1000, key);
      entities_.text(1000, short_text(text));
    };
    pair("layer", layer.name);
    if (!name.empty()) pair("class", name);
    entities_.text(1000, "value");
    entities_.number(1040, value);
    if (!area_mm2) return;
    entities_.text(1000, "area_mm2");
    entities_.number(1040, *area_mm2);
  }
  // Strings of extended data have at most 255 bytes.
  static std::string short_text(const std::string& text) {
    std::string out = plain(text);
    if (out.size() <= 255) return out;
    std::size_t end = 255;
    while ((static_cast<unsigned char>(out[end]) & 0xc0) == 0x80) --end;
    return out.substr(0, end);
  }

  Result<void> add_class(const LayerVectors& layer, const ClassArea& area) {
    const std::string name = names_.add(layer.name + " - " + area.name);
    layers_.push_back({name, area.color});
    const double shown = layer.opacity * area.color[3] / 255.0;
    for (const OutlinePolygon& polygon : area.polygons) {
      if (progress_.cancelled()) return cancelled_problem();
      const double area_mm2 = area_of(polygon) * drawing_.scale * drawing_.scale;
      if (area.pattern != Pattern::outline) {
        hatch(name, polygon, area, shown);
        attributes(layer, area.name, area.value, area_mm2);
      }
      for (const OutlineRing& ring : polygon.rings) {
        polyline(name, ring, true);
        attributes(layer, area.name, area.value, area_mm2);
      }
    }
    return {};
  }

  void hatch(const std::string& name, const OutlinePolygon& polygon, const ClassArea& area,
             double shown) {
    constexpr int kExternal = 1, kPolyline = 2, kOutermost = 16;
    const bool is_solid = area.pattern == Pattern::solid;
    begin_entity("HATCH", name);
    opacity(shown);
    entities_.text(100, "AcDbHatch");
    entities_.space_point(10, {0, 0});
    entities_.number(210, 0);
    entities_.number(220, 0);
    entities_.number(230, 1);
    entities_.text(2, is_solid ? "SOLID" : area.pattern == Pattern::dots ? "DOTS" : "LINES");
    entities_.whole(70, is_solid ? 1 : 0);
    entities_.whole(71, 0);
    entities_.whole(91, static_cast<std::int64_t>(polygon.rings.size()));
    for (std::size_t i = 0; i < polygon.rings.size(); ++i) {
      entities_.whole(92, kPolyline | (i == 0 ? kExternal : kOutermost));
      entities_.whole(72, 0);
      entities_.whole(73, 1);
      entities_.whole(93, static_cast<std::int64_t>(polygon.rings[i].size()));
      for (const glm::dvec2& point : polygon.rings[i]) add_point(10, point);
      entities_.whole(97, 0);
    }
    entities_.whole(75, 0);
    entities_.whole(76, is_solid ? 1 : 2);
    if (!is_solid) {
      const double spacing = area.spacing_mm * drawing_.scale;
      const glm::dvec2 along = direction(area.angle);
      const glm::dvec2 across(along.y, along.x);  // y up on the object
      entities_.number(52, 0);
      entities_.number(41, 1);
      entities_.whole(77, 0);
      entities_.whole(78, 1);
      entities_.number(53, area.angle);
      entities_.number(43, 0);
      entities_.number(44, 0);
      entities_.number(45, across.x * spacing);
      entities_.number(46, across.y * spacing);
      if (area.pattern == Pattern::dots) {
        entities_.whole(79, 2);
        entities_.number(49, 0);
        entities_.number(49, -spacing);
      } else {
        entities_.whole(79, 0);
      }
    }
    entities_.whole(98, 0);
  }

  void add_marks(const LayerVectors& layer) {
    const std::string name = names_.add(layer.name);
    std::optional<Rgba> color;
    if (!layer.marks.empty()) color = layer.marks[0].color;
    layers_.push_back({name, color});
    for (const RecordMark& mark : layer.marks) {
      if (mark.points.size() > 1) {
        polyline(name, mark.points, false);
      } else {
        begin_entity("POINT", name);
        entities_.text(100, "AcDbPoint");
        add_point(10, mark.points[0]);
        entities_.number(30, 0);
      }
      attributes(layer, {}, static_cast<double>(mark.key), std::nullopt);
    }
  }

  void add_labels() {
    const std::string name = names_.add("Labels");
    layers_.push_back({name, std::nullopt});
    for (const Label& label : drawing_.labels) {
      begin_entity("TEXT", name);
      entities_.text(100, "AcDbText");
      add_point(10, drawing_.area.corner + label.at);
      entities_.number(30, 0);
      entities_.number(40, kLabel_mm * drawing_.scale);
      entities_.text(1, drawn_text(label.text));
      entities_.whole(72, 1);  // centered
      add_point(11, drawing_.area.corner + label.at);
      entities_.number(31, 0);
      entities_.text(100, "AcDbText");
      entities_.whole(73, 2);  // at half height
    }
  }

  // ── sections ───────────────────────────────────────────────────────────────────────────────────

  static void begin_section(Pairs& pairs, const char* name) {
    pairs.text(0, "SECTION");
    pairs.text(2, name);
  }

  void write_header(Pairs& pairs) const {
    begin_section(pairs, "HEADER");
    const auto name = [&](const char* variable) { pairs.text(9, variable); };
    name("$ACADVER");
    pairs.text(1, "AC1021");
    name("$DWGCODEPAGE");
    pairs.text(3, "ANSI_1252");  // texts are UTF-8 since AC1021
    name("$INSUNITS");
    pairs.whole(70, 4);  // millimeters
    name("$MEASUREMENT");
    pairs.whole(70, 1);  // metric
    name("$HANDSEED");
    pairs.handle(5, next_);
    const bool has_content = low_.x <= high_.x;
    name("$EXTMIN");
    pairs.space_point(10, has_content ? low_ : glm::dvec2(0));
    name("$EXTMAX");
    pairs.space_point(10, has_content ? high_ : glm::dvec2(0));
    pairs.text(0, "ENDSEC");
  }

  static void begin_table(Pairs& pairs, const char* name, unsigned handle, std::size_t entries) {
    pairs.text(0, "TABLE");
    pairs.text(2, name);
    pairs.handle(5, handle);
    pairs.whole(330, 0);
    pairs.text(100, "AcDbSymbolTable");
    pairs.whole(70, static_cast<std::int64_t>(entries));
  }
  void begin_record(Pairs& pairs, const char* type, unsigned table, const char* subclass) {
    pairs.text(0, type);
    pairs.handle(5, new_handle());
    pairs.handle(330, table);
    pairs.text(100, "AcDbSymbolTableRecord");
    pairs.text(100, subclass);
  }

  void write_layer(Pairs& pairs, const DxfLayer& layer) {
    begin_record(pairs, "LAYER", kLayerTable, "AcDbLayerTableRecord");
    pairs.text(2, layer.name);
    pairs.whole(70, 0);
    pairs.whole(62, kWhite);
    if (layer.color) pairs.whole(420, true_color(*layer.color));
    pairs.text(6, "Continuous");
  }

  void write_tables(Pairs& pairs) {
    begin_section(pairs, "TABLES");
    const auto end = [&] { pairs.text(0, "ENDTAB"); };
    begin_table(pairs, "VPORT", kViewportTable, 0);
    end();
    begin_table(pairs, "LTYPE", kLinetypeTable, 3);
    for (const char* name : {"ByBlock", "ByLayer", "Continuous"}) {
      begin_record(pairs, "LTYPE", kLinetypeTable, "AcDbLinetypeTableRecord");
      pairs.text(2, name);
      pairs.whole(70, 0);
      pairs.text(3, "");
      pairs.whole(72, 65);
      pairs.whole(73, 0);
      pairs.number(40, 0);
    }
    end();
    begin_table(pairs, "LAYER", kLayerTable, layers_.size() + 1);
    write_layer(pairs, {"0", std::nullopt});
    for (const DxfLayer& layer : layers_) write_layer(pairs, layer);
    end();
    begin_table(pairs, "STYLE", kStyleTable, 1);
    begin_record(pairs, "STYLE", kStyleTable, "AcDbTextStyleTableRecord");
    pairs.text(2, "Standard");
    pairs.whole(70, 0);
    pairs.number(40, 0);
    pairs.number(41, 1);
    pairs.number(50, 0);
    pairs.whole(71, 0);
    pairs.number(42, kLabel_mm);
    pairs.text(3, "arial.ttf");  // has letters of more languages than the fonts of AutoCAD
    pairs.text(4, "");
    end();
    begin_table(pairs, "VIEW", kViewTable, 0);
    end();
    begin_table(pairs, "UCS", kUcsTable, 0);
    end();
    begin_table(pairs, "APPID", kApplicationTable, 2);
    for (const char* name : {"ACAD", "STRATA"}) {
      begin_record(pairs, "APPID", kApplicationTable, "AcDbRegAppTableRecord");
      pairs.text(2, name);
      pairs.whole(70, 0);
    }
    end();
    begin_table(pairs, "DIMSTYLE", kDimensionTable, 1);
    pairs.text(100, "AcDbDimStyleTable");
    pairs.text(0, "DIMSTYLE");
    pairs.handle(105, new_handle());
    pairs.handle(330, kDimensionTable);
    pairs.text(100, "AcDbSymbolTableRecord");
    pairs.text(100, "AcDbDimStyleTableRecord");
    pairs.text(2, "Standard");
    pairs.whole(70, 0);
    end();
    begin_table(pairs, "BLOCK_RECORD", kBlockTable, 2);
    for (const auto& [name, handle] :
         {std::pair("*Model_Space", kModelSpace), std::pair("*Paper_Space", kPaperSpace)}) {
      pairs.text(0, "BLOCK_RECORD");
      pairs.handle(5, handle);
      pairs.handle(330, kBlockTable);
      pairs.text(100, "AcDbSymbolTableRecord");
      pairs.text(100, "AcDbBlockTableRecord");
      pairs.text(2, name);
    }
    end();
    pairs.text(0, "ENDSEC");
  }

  void write_blocks(Pairs& pairs) const {
    begin_section(pairs, "BLOCKS");
    unsigned handle = kGroupDictionary + 1;  // free handles below kFirstFree
    for (const auto& [name, record] :
         {std::pair("*Model_Space", kModelSpace), std::pair("*Paper_Space", kPaperSpace)}) {
      const auto begin = [&, record = record](const char* type, const char* subclass) {
        pairs.text(0, type);
        pairs.handle(5, handle++);
        pairs.handle(330, record);
        pairs.text(100, "AcDbEntity");
        pairs.text(8, "0");
        pairs.text(100, subclass);
      };
      begin("BLOCK", "AcDbBlockBegin");
      pairs.text(2, name);
      pairs.whole(70, 0);
      pairs.space_point(10, {0, 0});
      pairs.text(3, name);
      pairs.text(1, "");
      begin("ENDBLK", "AcDbBlockEnd");
    }
    pairs.text(0, "ENDSEC");
  }

  static void write_objects(Pairs& pairs) {
    begin_section(pairs, "OBJECTS");
    const auto dictionary = [&](unsigned handle, unsigned owner) {
      pairs.text(0, "DICTIONARY");
      pairs.handle(5, handle);
      pairs.handle(330, owner);
      pairs.text(100, "AcDbDictionary");
      pairs.whole(281, 1);
    };
    dictionary(kRootDictionary, 0);
    pairs.text(3, "ACAD_GROUP");
    pairs.handle(350, kGroupDictionary);
    dictionary(kGroupDictionary, kRootDictionary);
    pairs.text(0, "ENDSEC");
  }

  const DxfDrawing& drawing_;
  const Progress& progress_;
  std::ostringstream entity_text_;
  Pairs entities_;
  LayerNames names_;
  std::vector<DxfLayer> layers_;
  unsigned next_ = kFirstFree;
  glm::dvec2 low_{1e300}, high_{-1e300};
};

}  // namespace

Result<void> write_dxf(const DxfDrawing& drawing, const std::filesystem::path& file,
                       const Progress& progress) {
  return DxfWriter(drawing, progress).write(file);
}

}  // namespace strata::figure
