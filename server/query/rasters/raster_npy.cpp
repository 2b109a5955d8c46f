#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "query/rasters/raster.h"
#include "query/rasters/raster_rows.h"
#include "query/rasters/raster_samples.h"

namespace strata::query {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
// Strata writes about 120 bytes; NumPy pads to a multiple of 64
constexpr std::size_t kMaxHeader = 4096;

std::string dtype_of(ValueType type) {
  static constexpr const char* kNames[] = {"|u1", "<u2", "<u4", "|i1", "<i2", "<i4", "<f2", "<f4"};
  return kNames[static_cast<std::size_t>(type)];
}

struct Header {
  std::string descr;  // without blanks, with single quotes
  bool fortran_order = false;
  std::string shape;  // "(2048,2048)"
  std::size_t data_at = 0;
};

// Returns the value of a key in a Python dictionary without blanks. The value is the text up to the
// comma or brace that ends it.
std::optional<std::string> value_of(const std::string& dictionary, const std::string& key) {
  const auto at = dictionary.find("'" + key + "':");
  if (at == std::string::npos) return std::nullopt;
  const std::size_t begin = at + key.size() + 3;
  int depth = 0;
  for (std::size_t i = begin; i < dictionary.size(); ++i) {
    const char c = dictionary[i];
    if (depth == 0 && (c == ',' || c == '}')) return dictionary.substr(begin, i - begin);
    if (c == '(' || c == '[' || c == '{') ++depth;
    if (c == ')' || c == ']' || c == '}') --depth;
  }
  return std::nullopt;
}

Result<Header> read_header(std::span<const std::uint8_t> bytes) {
  auto damaged = [] {
    return refuse_raster("This is not a NumPy file, or its header is damaged.");
  };
  if (bytes.size() < 12 || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
    return damaged();
  const int version = bytes[6];
  if (version < 1 || version > 3)
    return refuse_raster("NumPy format version " + std::to_string(version) + " is not supported.");
  const std::size_t start = version == 1 ? 10 : 12;
  std::size_t length = bytes[8] | bytes[9] << 8;
  if (version > 1) length |= std::size_t(bytes[10]) << 16 | std::size_t(bytes[11]) << 24;
  if (length > kMaxHeader || start + length > bytes.size()) return damaged();

  std::string text;
  for (const std::uint8_t byte : bytes.subspan(start, length)) {
    const char c = static_cast<char>(byte);
    if (c == ' ' || c == '\n' || c == '\t') continue;
    text += c == '"' ? '\'' : c;
  }
  const auto descr = value_of(text, "descr"), order = value_of(text, "fortran_order"),
             shape = value_of(text, "shape");
  if (!descr || !order || !shape || (*order != "True" && *order != "False")) return damaged();
  return Header{*descr, *order == "True", *shape, start + length};
}

Result<void> check_shape(const Layer& layer, const Header& header) {
  const std::string side = std::to_string(layer.resolution);
  if (header.shape == "(" + side + "," + side + ")") return {};
  return refuse_raster("The shape of the array is " + header.shape.substr(0, 100) +
                       ", but the layer needs " + raster_needs(layer) + ".");
}

// Parses a type such as "'>f4'".
std::optional<SampleForm> form_of(std::string_view dtype) {
  if (dtype.size() != 5 || dtype.front() != '\'' || dtype.back() != '\'') return std::nullopt;
  const char order = dtype[1], kind = dtype[2];
  if (std::string_view("<>|=").find(order) == std::string_view::npos) return std::nullopt;
  SampleForm form;
  form.bytes = dtype[3] - '0';
  form.is_big_endian = order == '>';
  if (kind == 'u')
    form.kind = SampleForm::Kind::unsigned_whole;
  else if (kind == 'i')
    form.kind = SampleForm::Kind::signed_whole;
  else if (kind == 'f')
    form.kind = SampleForm::Kind::real;
  else if (kind == 'b')
    form.kind = SampleForm::Kind::truth;
  else
    return std::nullopt;
  const int least = kind == 'f' ? 2 : 1, most = kind == 'b' ? 1 : 8;
  const bool is_length = std::has_single_bit(static_cast<unsigned>(std::max(form.bytes, 0)));
  return is_length && form.bytes >= least && form.bytes <= most ? std::optional(form)
                                                                : std::nullopt;
}

// The storage format of an element: a value, followed in a structured array by a valid flag.
struct Element {
  SampleForm value;
  std::optional<SampleForm> valid;

  std::size_t bytes() const {
    return static_cast<std::size_t>(value.bytes + (valid ? valid->bytes : 0));
  }
};

Result<Element> element_of(const std::string& descr) {
  constexpr std::string_view kFirst = "[('value',", kSecond = "),('valid',", kLast = ")]";
  if (const auto value = form_of(descr)) return Element{*value, {}};
  const std::string_view text = descr;
  constexpr std::size_t kType = 5;  // "'<f4'"
  if (text.size() == kFirst.size() + kSecond.size() + kLast.size() + 2 * kType &&
      text.starts_with(kFirst) && text.substr(kFirst.size() + kType).starts_with(kSecond) &&
      text.ends_with(kLast)) {
    const auto value = form_of(text.substr(kFirst.size(), kType)),
               valid = form_of(text.substr(text.size() - kLast.size() - kType, kType));
    if (value && valid && valid->bytes == 1) return Element{*value, valid};
  }
  return refuse_raster("The type of the array is " + descr.substr(0, 200) +
                       ". A layer accepts bool, whole numbers of 1 to 8 bytes and floating-point "
                       "numbers of 2 to 8 bytes, alone or as [('value', …), ('valid', '|b1')].");
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_npy(const Layer& layer, const TileMap& tiles) {
  const std::string side = std::to_string(layer.resolution);
  std::string header = "{'descr': [('value', '" + dtype_of(layer.type) +
                       "'), ('valid', '|b1')], 'fortran_order': False, 'shape': (" + side + ", " +
                       side + "), }";
  constexpr std::size_t kBefore = 10;
  header.append(63 - (kBefore + header.size()) % 64, ' ');  // data begins at a multiple of 64
  header += '\n';

  const int width = bytes_per_texel(layer.type);
  const std::size_t row_bytes = std::size_t(layer.resolution) * (width + 1);
  std::vector<std::uint8_t> out(kMagic.begin(), kMagic.end());
  out.reserve(kBefore + header.size() + row_bytes * layer.resolution);
  out.insert(out.end(), {1, 0, static_cast<std::uint8_t>(header.size()),
                         static_cast<std::uint8_t>(header.size() >> 8)});
  out.insert(out.end(), header.begin(), header.end());

  const TileRows rows(layer, tiles);
  std::vector<std::uint32_t> bits(layer.resolution);
  std::vector<std::uint8_t> valid(layer.resolution);
  for (int row = 0; row < layer.resolution; ++row) {
    rows.read(row, bits, valid);
    std::size_t at = out.size();
    out.resize(at + row_bytes);
    for (int x = 0; x < layer.resolution; ++x, at += width + 1) {
      std::memcpy(out.data() + at, &bits[x], width);
      out[at + width] = valid[x];
    }
  }
  return out;
}

Result<TileMap> decode_npy(const Layer& layer, std::span<const std::uint8_t> bytes) {
  auto header = STRATA_TRY(read_header(bytes));
  const auto element = STRATA_TRY(element_of(header.descr));
  STRATA_TRY(check_shape(layer, header));

  const auto side = static_cast<std::size_t>(layer.resolution), stride = element.bytes();
  const std::span<const std::uint8_t> data = bytes.subspan(header.data_at);
  if (data.size() != side * side * stride)
    return refuse_raster("The file contains " + std::to_string(data.size()) +
                         " bytes of texels, but its header declares " +
                         std::to_string(side * side * stride) + ". It is incomplete or damaged.");
  TileMapBuilder builder(layer);
  const SampleReader reader(layer, element.value);
  // Follows the order of the file, so that memory is read sequentially.
  const std::uint8_t* texel = data.data();
  for (std::size_t slow = 0; slow < side; ++slow)
    for (std::size_t fast = 0; fast < side; ++fast, texel += stride) {
      if (element.valid ? texel[element.value.bytes] == 0 : reader.is_nodata(texel)) continue;
      const auto row = static_cast<int>(header.fortran_order ? fast : slow),
                 x = static_cast<int>(header.fortran_order ? slow : fast);
      STRATA_TRY(reader.put(builder, x, row, texel));
    }
  return builder.finish();
}

}  // namespace strata::query
