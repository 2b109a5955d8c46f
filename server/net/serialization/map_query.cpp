#include "net/serialization/map_query.h"

#include <charconv>

#include "net/http/upload.h"

namespace strata::net {
namespace {

constexpr const char* kMapUpload =
    "Send the map as the body (GeoJSON, TIFF, PNG, JPEG, or a zip), or send its files together "
    "(such as .shp, .dbf and .prj) in a multipart/form-data form.";
constexpr double kMaxFloat = 3.4028234663852886e38;
constexpr int kMaxBands = 65535;  // maximum number of bands in a TIFF

// Returns nothing if the parameter is absent.
std::optional<std::string> text_of(const Request& request, const std::string& name) {
  const auto found = request.query.find(name);
  return found == request.query.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace

Result<double> number_of(const Request& request, const std::string& name, double low, double high,
                         std::optional<double> fallback) {
  const auto found = request.query.find(name);
  if (found == request.query.end()) {
    if (fallback) return *fallback;
    return fail(ErrorCode::invalid, "Parameter missing", "Send `" + name + "`.", name);
  }
  double value = 0;
  const std::string& text = found->second;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= low && value <= high))
    return fail(ErrorCode::invalid, "Parameter out of range",
                "`" + name + "` must be a number in the allowed range.", name);
  return value;
}

Result<app::MapAxis> map_axis(const Request& request) {
  return app::parse_map_axis(request.query_or("along", "-z"));
}

Result<app::MapOptions> map_options(const Request& request) {
  app::MapOptions options;
  options.world = text_of(request, "world");
  options.crs = request.query_or("crs", {});
  options.attribute = request.query_or("attribute", {});
  options.names = request.query_or("names", {});
  options.colors = text_of(request, "colors");
  if (request.query.contains("value"))
    options.value = STRATA_TRY(number_of(request, "value", -kMaxFloat, kMaxFloat));
  if (const auto band = text_of(request, "band"))
    options.band = static_cast<int>(STRATA_TRY(parse_integer(*band, 1, kMaxBands, "band")));
  options.tolerance = STRATA_TRY(number_of(request, "tolerance", app::kMinTolerance,
                                           app::kMaxTolerance, query::kUsualTolerance));
  return options;
}

Result<app::MapFiles> take_map(const Request& request, const std::filesystem::path& folder) {
  const auto uploads = STRATA_TRY(take_upload(request, folder, kMapUpload));
  std::vector<app::MapFile> files;
  for (const Upload& upload : uploads)
    files.push_back({upload.file, upload.filename, upload.file != request.body_file});
  return app::MapFiles::open(files, folder);
}

}  // namespace strata::net
