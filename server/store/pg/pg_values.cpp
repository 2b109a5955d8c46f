#include <bit>
#include <cstring>

#include "store/pg/pg.h"

namespace strata::store {
namespace {

// PostgreSQL counts time from 2000-01-01
constexpr std::int64_t kEpoch2000_us = 946'684'800'000'000;

template <class T>
void append_big_endian(std::string& out, T value) {
  for (int shift = static_cast<int>(sizeof(T)) * 8 - 8; shift >= 0; shift -= 8)
    out.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> shift));
}

std::uint64_t read_big_endian(const char* data, int size) {
  std::uint64_t value = 0;
  for (int i = 0; i < size; ++i) value = (value << 8) | static_cast<unsigned char>(data[i]);
  return value;
}

template <class T>
std::string big_endian(T value) {
  std::string out;
  append_big_endian(out, value);
  return out;
}

std::int64_t to_pg_time(Time time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(time.time_since_epoch()).count() -
         kEpoch2000_us;
}

std::string_view view_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

void PgArray::add_raw(const void* data, std::size_t size) {
  append_big_endian(body_, static_cast<std::int32_t>(size));
  body_.append(static_cast<const char*>(data), size);
  ++count_;
}
void PgArray::add(std::int64_t value) {
  const auto raw = big_endian(value);
  add_raw(raw.data(), raw.size());
}
void PgArray::add_int2(std::int16_t value) {
  const auto raw = big_endian(value);
  add_raw(raw.data(), raw.size());
}
void PgArray::add(double value) { add(std::bit_cast<std::int64_t>(value)); }
void PgArray::add(std::string_view text) { add_raw(text.data(), text.size()); }
void PgArray::add(Bytes bytes) { add_raw(bytes.data(), bytes.size()); }
void PgArray::add(const Uuid& uuid) { add_raw(uuid.bytes.data(), uuid.bytes.size()); }
void PgArray::add(const nlohmann::json& json) {
  const std::string raw = '\1' + json.dump();
  add_raw(raw.data(), raw.size());
}
void PgArray::add(Time time) { add(to_pg_time(time)); }
void PgArray::add_null() {
  append_big_endian(body_, std::int32_t{-1});
  has_null_ = true;
  ++count_;
}

std::string PgArray::encode() const {
  std::string out;
  out.reserve(20 + body_.size());
  append_big_endian(out, std::int32_t{count_ > 0 ? 1 : 0});
  append_big_endian(out, std::int32_t{has_null_ ? 1 : 0});
  append_big_endian(out, static_cast<std::uint32_t>(element_));
  if (count_ > 0) {
    append_big_endian(out, std::int32_t{count_});
    append_big_endian(out, std::int32_t{1});  // array indices begin at 1
    out += body_;
  }
  return out;
}

namespace {

Oid array_of(Oid element) {
  switch (element) {
    case oid::kBytea: return 1001;
    case oid::kInt2: return 1005;
    case oid::kText: return 1009;
    case oid::kInt8: return 1016;
    case oid::kFloat8: return 1022;
    case oid::kTimestamptz: return 1185;
    case oid::kUuid: return 2951;
    case oid::kJsonb: return 3807;
    default: return 0;
  }
}

}  // namespace

Params& Params::own(Oid type, std::string value) {
  owned_.push_back(std::move(value));
  types_.push_back(type);
  values_.push_back(owned_.back().data());
  lengths_.push_back(static_cast<int>(owned_.back().size()));
  formats_.push_back(1);
  return *this;
}
Params& Params::null(Oid type) {
  types_.push_back(type);
  values_.push_back(nullptr);
  lengths_.push_back(0);
  formats_.push_back(1);
  return *this;
}
Params& Params::integer(std::int64_t value) { return own(oid::kInt8, big_endian(value)); }
Params& Params::optional_integer(std::optional<std::int64_t> value) {
  return value ? integer(*value) : null(oid::kInt8);
}
Params& Params::real(double value) {
  return own(oid::kFloat8, big_endian(std::bit_cast<std::int64_t>(value)));
}
Params& Params::boolean(bool value) { return own(oid::kBool, std::string(1, value ? '\1' : '\0')); }
Params& Params::text(std::string_view value) { return own(oid::kText, std::string(value)); }
Params& Params::optional_text(const std::optional<std::string>& value) {
  return value ? text(std::string_view(*value)) : null(oid::kText);
}
Params& Params::bytes(Bytes value) {
  types_.push_back(oid::kBytea);
  // A null pointer would mean NULL, and an empty span may have a null pointer.
  values_.push_back(value.empty() ? "" : reinterpret_cast<const char*>(value.data()));
  lengths_.push_back(static_cast<int>(value.size()));
  formats_.push_back(1);
  return *this;
}
Params& Params::uuid(const Uuid& value) {
  return own(oid::kUuid,
             std::string(reinterpret_cast<const char*>(value.bytes.data()), value.bytes.size()));
}
Params& Params::json(const nlohmann::json& value) { return own(oid::kJsonb, '\1' + value.dump()); }
Params& Params::time(std::optional<Time> value) {
  return value ? own(oid::kTimestamptz, big_endian(to_pg_time(*value))) : null(oid::kTimestamptz);
}
Params& Params::array(const PgArray& value) {
  return own(array_of(value.element()), value.encode());
}

std::int64_t PgResult::affected() const {
  const char* count = PQcmdTuples(result_.get());
  return count && *count ? std::strtoll(count, nullptr, 10) : 0;
}
std::int64_t PgResult::integer(int row, int column) const {
  const int size = PQgetlength(result_.get(), row, column);
  const auto raw = read_big_endian(PQgetvalue(result_.get(), row, column), size);
  if (size == 2) return static_cast<std::int16_t>(raw);
  if (size == 4) return static_cast<std::int32_t>(raw);
  return static_cast<std::int64_t>(raw);
}
double PgResult::real(int row, int column) const {
  return std::bit_cast<double>(read_big_endian(PQgetvalue(result_.get(), row, column), 8));
}
bool PgResult::boolean(int row, int column) const {
  return *PQgetvalue(result_.get(), row, column) != 0;
}
std::string PgResult::text(int row, int column) const {
  return std::string(view_of(bytes(row, column)));
}
Bytes PgResult::bytes(int row, int column) const {
  return {reinterpret_cast<const std::uint8_t*>(PQgetvalue(result_.get(), row, column)),
          static_cast<std::size_t>(PQgetlength(result_.get(), row, column))};
}
Uuid PgResult::uuid(int row, int column) const {
  Uuid uuid;
  const Bytes raw = bytes(row, column);
  std::memcpy(uuid.bytes.data(), raw.data(), std::min(raw.size(), uuid.bytes.size()));
  return uuid;
}
nlohmann::json PgResult::json(int row, int column) const {
  if (null(row, column)) return nullptr;
  // the text follows the version byte of jsonb
  return nlohmann::json::parse(view_of(bytes(row, column)).substr(1));
}
Time PgResult::time(int row, int column) const {
  return Time(std::chrono::duration_cast<Time::duration>(
      std::chrono::microseconds(integer(row, column) + kEpoch2000_us)));
}
std::vector<double> PgResult::reals(int row, int column) const {
  std::vector<double> out;
  const Bytes raw = bytes(row, column);
  if (raw.size() < 20) return out;
  const char* data = reinterpret_cast<const char*>(raw.data());
  const auto count = read_big_endian(data + 12, 4);
  for (std::size_t i = 0; i < count && 20 + (i + 1) * 12 <= raw.size(); ++i)
    out.push_back(std::bit_cast<double>(read_big_endian(data + 24 + i * 12, 8)));
  return out;
}

// The signature, and two fields that are 0: the flags and the size of an extension.
std::string copy_header() { return {"PGCOPY\n\377\r\n\0\0\0\0\0\0\0\0\0", 11 + 4 + 4}; }
void append_row_start(std::string& row, std::int16_t fields) { append_big_endian(row, fields); }
void append_field(std::string& row, Bytes bytes) {
  append_big_endian(row, static_cast<std::int32_t>(bytes.size()));
  row += view_of(bytes);
}
void append_int4(std::string& row, std::int32_t value) {
  append_big_endian(row, std::int32_t{4});
  append_big_endian(row, value);
}
std::string copy_trailer() { return big_endian(std::int16_t{-1}); }

Result<void> check_text(std::string_view text, const std::string& field) {
  const auto refuse = [&] {
    return fail(ErrorCode::malformed, "Text cannot be stored",
                "`" + field + "` must be UTF-8 without the character U+0000.", field);
  };
  std::size_t i = 0;
  while (i < text.size()) {
    const auto lead = static_cast<unsigned char>(text[i]);
    if (lead == 0) return refuse();
    const int more = lead < 0x80                   ? 0
                     : lead >= 0xc2 && lead < 0xe0 ? 1
                     : (lead & 0xf0) == 0xe0       ? 2
                     : lead >= 0xf0 && lead < 0xf5 ? 3
                                                   : -1;
    if (more < 0 || i + more >= text.size()) return refuse();
    std::uint32_t code = more == 0 ? lead : lead & (0x3f >> more);
    for (int k = 1; k <= more; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      if ((next & 0xc0) != 0x80) return refuse();
      code = (code << 6) | (next & 0x3f);
    }
    const bool overlong = (more == 2 && code < 0x800) || (more == 3 && code < 0x10000);
    if (overlong || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return refuse();
    i += more + 1;
  }
  return {};
}

}  // namespace strata::store
