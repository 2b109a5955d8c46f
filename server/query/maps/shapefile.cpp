#include "query/maps/shapefile.h"

#include <shapefil.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>

#include "query/maps/dbf_text.h"
#include "query/maps/shapelib_memory.h"

namespace strata::query {
namespace {

constexpr std::size_t kShpHeader = 100, kRecordHeader = 8, kShxRecord = 8, kDbfHeader = 32;
constexpr std::size_t kMaxSkipped = 100'000;  // records without a shape

tl::unexpected<Error> refuse(const std::string& what) {
  return fail(ErrorCode::invalid, "Shapefile cannot be read", what, "body");
}

std::uint32_t big_endian(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 |
         std::uint32_t{bytes[at + 2]} << 8 | std::uint32_t{bytes[at + 3]};
}
std::uint32_t little_endian(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::uint32_t{bytes[at + 3]} << 24 | std::uint32_t{bytes[at + 2]} << 16 |
         std::uint32_t{bytes[at + 1]} << 8 | std::uint32_t{bytes[at]};
}
void put_big_endian(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

bool is_polygon(std::uint32_t type) {
  return type == SHPT_POLYGON || type == SHPT_POLYGONZ || type == SHPT_POLYGONM;
}

std::string shape_name(std::uint32_t type) {
  switch (type) {
    case SHPT_POINT:
    case SHPT_POINTZ:
    case SHPT_POINTM:
    case SHPT_MULTIPOINT:
    case SHPT_MULTIPOINTZ:
    case SHPT_MULTIPOINTM: return "points";
    case SHPT_ARC:
    case SHPT_ARCZ:
    case SHPT_ARCM: return "lines";
    case SHPT_MULTIPATCH: return "multipatches";
    default: return "shapes of type " + std::to_string(type);
  }
}

// Makes the index for shapelib, with the position of each shape. All shapes must be within the
// file.
Result<std::vector<std::uint8_t>> index_of(std::span<const std::uint8_t> shp) {
  if (shp.size() < kShpHeader || !is_shapefile(shp))
    return refuse("The .shp file is not a shapefile.");
  const std::uint32_t type = little_endian(shp, 32);
  if (type != SHPT_NULL && !is_polygon(type))
    return refuse("The server can paint only polygons. The .shp contains " + shape_name(type) +
                  ".");
  const std::uint64_t declared_length = std::uint64_t{big_endian(shp, 24)} * 2;
  if (declared_length > shp.size())
    return refuse("The .shp is incomplete: it should have " + std::to_string(declared_length) +
                  " bytes and has " + std::to_string(shp.size()) + ".");
  std::vector<std::uint8_t> shx(shp.begin(), shp.begin() + kShpHeader);
  std::size_t records = 0;
  for (std::size_t at = kShpHeader; at < declared_length; ++records) {
    const std::string record = "Record " + std::to_string(records + 1) + " of the .shp ";
    if (records == kMaxMapFeatures)
      return refuse("A map can have at most " + std::to_string(kMaxMapFeatures) +
                    " features. Send the map in parts.");
    if (declared_length - at < kRecordHeader + 4) return refuse(record + "is incomplete.");
    const std::uint64_t length = std::uint64_t{big_endian(shp, at + 4)} * 2;
    if (length < 4 || length > declared_length - at - kRecordHeader)
      return refuse(record + "is longer than the file.");
    const std::uint32_t shape = little_endian(shp, at + kRecordHeader);
    if (shape != SHPT_NULL && shape != type)
      return refuse(record + "has another type than the file.");
    put_big_endian(shx, static_cast<std::uint32_t>(at / 2));
    put_big_endian(shx, static_cast<std::uint32_t>(length / 2));
    at += kRecordHeader + length;
  }
  const auto words = static_cast<std::uint32_t>((kShpHeader + records * kShxRecord) / 2);
  for (int i = 0; i < 4; ++i) shx[24 + i] = static_cast<std::uint8_t>(words >> (24 - 8 * i));
  return shx;
}

// Checks that the file contains all bytes of the records.
Result<void> check_dbf(std::span<const std::uint8_t> dbf, std::size_t shapes) {
  if (dbf.size() < kDbfHeader) return refuse("The .dbf is incomplete.");
  const std::uint64_t records = little_endian(dbf, 4);
  const std::uint64_t header = little_endian(dbf, 8) & 0xffff, record = little_endian(dbf, 8) >> 16;
  if (header <= kDbfHeader || record < 1)
    return refuse("The .dbf is damaged: its header has no fields.");
  if (header + records * record > dbf.size())
    return refuse("The .dbf is incomplete: it should contain " + std::to_string(records) +
                  " records of " + std::to_string(record) + " bytes.");
  if (records != shapes)
    return refuse("The .shp has " + std::to_string(shapes) + " shapes and the .dbf has " +
                  std::to_string(records) + " records: the files do not belong together.");
  const std::uint64_t fields = (header - kDbfHeader) / kDbfHeader;
  if (fields > kMaxMapColumns)
    return refuse("A map can have at most " + std::to_string(kMaxMapColumns) + " attributes.");
  if (fields * records > kMaxMapValues) return refuse(too_many_values());
  return {};
}

struct CloseShapes {
  void operator()(SHPInfo* shapes) const { SHPClose(shapes); }
};
struct CloseTable {
  void operator()(DBFInfo* table) const { DBFClose(table); }
};
struct DestroyShape {
  void operator()(SHPObject* shape) const { SHPDestroyObject(shape); }
};

MapValue number_in(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() ||
      !std::isfinite(value))
    return {};
  return value;
}

class Reader {
 public:
  explicit Reader(const ShapefileParts& parts) : parts_(parts) {}

  Result<FeatureMap> read() {
    auto shx = STRATA_TRY(index_of(parts_.shp));
    const std::size_t records = (shx.size() - kShpHeader) / kShxRecord;
    if (!parts_.dbf.empty()) STRATA_TRY(check_dbf(parts_.dbf, records));
    ShapelibMemory memory{{{"map.shp", parts_.shp}, {"map.shx", shx}, {"map.dbf", parts_.dbf}}};
    const std::unique_ptr<SHPInfo, CloseShapes> shapes(SHPOpenLL("map.shp", "rb", memory.hooks()));
    if (!shapes) return refuse(memory.complaint("The .shp cannot be read"));
    std::unique_ptr<DBFInfo, CloseTable> table;
    if (!parts_.dbf.empty()) {
      table.reset(DBFOpenLL("map.dbf", "rb", memory.hooks()));
      if (!table) return refuse(memory.complaint("The .dbf cannot be read"));
      read_columns(table.get());
    }
    map_.crs = epsg_of(parts_.prj);
    map_.in_degrees = parts_.prj.starts_with("GEOGCS") || parts_.prj.starts_with("GEOGCRS");
    for (int i = 0; i < static_cast<int>(records); ++i) {
      if (table && DBFIsRecordDeleted(table.get(), i)) continue;
      const std::unique_ptr<SHPObject, DestroyShape> shape(SHPReadObject(shapes.get(), i));
      if (!shape)
        return refuse(
            memory.complaint("Record " + std::to_string(i + 1) + " of the .shp cannot be read"));
      if (shape->nSHPType == SHPT_NULL) {
        if (++skipped_ > kMaxSkipped) return refuse("Too many records of the .shp have no shape.");
        continue;
      }
      STRATA_TRY(keep(*shape, table.get(), i));
    }
    return std::move(map_);
  }

 private:
  void read_columns(DBFInfo* table) {
    text_.emplace(parts_.cpg, DBFGetCodePage(table));
    for (int c = 0; c < DBFGetFieldCount(table); ++c) {
      char name[XBASE_FLDNAME_LEN_READ + 1] = {};
      types_.push_back(DBFGetFieldInfo(table, c, name, nullptr, nullptr));
      map_.columns.push_back(text_->utf8(name));
    }
  }

  Result<void> keep(const SHPObject& shape, DBFInfo* table, int record) {
    MapFeature feature{{}, {}, "Record " + std::to_string(record + 1)};
    const auto bad = [&](const std::string& what) {
      return refuse(feature.place + " of the .shp " + what);
    };
    points_ += static_cast<std::size_t>(shape.nVertices);
    if (points_ > kMaxMapPoints)
      return refuse("A map can have at most " + std::to_string(kMaxMapPoints) +
                    " points. Send the map in parts.");
    MapFeature::Rings rings;
    for (int part = 0; part < shape.nParts; ++part) {
      const int begin = shape.panPartStart[part];
      const int end = part + 1 < shape.nParts ? shape.panPartStart[part + 1] : shape.nVertices;
      if (begin < 0 || begin > end || end > shape.nVertices)
        return bad("has rings outside its outline.");
      if (end - begin < 3) return bad("has a ring of fewer than three points.");
      auto& ring = rings.emplace_back();
      for (int v = begin; v < end; ++v) {
        const glm::dvec2 at(shape.padfX[v], shape.padfY[v]);
        if (!std::isfinite(at.x) || !std::isfinite(at.y))
          return bad("has a coordinate that is not a finite number.");
        ring.push_back(at);
      }
    }
    if (rings.empty()) return {};
    feature.polygons.push_back(std::move(rings));
    for (int c = 0; c < static_cast<int>(types_.size()); ++c)
      feature.values.push_back(value_of(table, record, c));
    map_.features.push_back(std::move(feature));
    return {};
  }

  MapValue value_of(DBFInfo* table, int record, int column) const {
    if (DBFIsAttributeNULL(table, record, column)) return {};
    const char* held = DBFReadStringAttribute(table, record, column);
    if (!held) return {};
    switch (types_[static_cast<std::size_t>(column)]) {
      case FTInteger:
      case FTDouble: return number_in(held);
      case FTLogical:
        return std::string_view("TtYy").find(*held) != std::string_view::npos ? 1.0 : 0.0;
      default: return text_->utf8(held);
    }
  }

  const ShapefileParts& parts_;
  FeatureMap map_;
  std::vector<DBFFieldType> types_;
  std::optional<DbfText> text_;
  std::size_t points_ = 0, skipped_ = 0;
};

}  // namespace

bool is_shapefile(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kMagic[] = {0, 0, 0x27, 0x0a};
  return bytes.size() >= 4 && std::equal(std::begin(kMagic), std::end(kMagic), bytes.begin());
}

Result<FeatureMap> parse_shapefile(const ShapefileParts& parts) { return Reader(parts).read(); }

std::string epsg_of(std::string_view wkt) {
  const auto found = wkt.rfind("AUTHORITY[\"EPSG\",\"");
  if (found == std::string_view::npos) return {};
  std::string_view rest = wkt.substr(found + 18);
  const auto digits = rest.find_first_not_of("0123456789");
  if (digits == 0 || digits == std::string_view::npos || digits > 6 || rest[digits] != '"')
    return {};
  // The last authority belongs to the whole coordinate system only if nothing else follows it.
  if (rest.substr(digits + 1).find_first_not_of("] \r\n\t") != std::string_view::npos) return {};
  return "EPSG:" + std::string(rest.substr(0, digits));
}

}  // namespace strata::query
