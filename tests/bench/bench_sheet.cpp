// A contact sheet: each model as the renderer draws it under a checker layer, for a person to judge seams, distortion and
// density. An SVG with JPEG pictures, which any browser shows.
#include <fstream>
#include <sstream>

#include "bench/bench_commands.h"
#include "bench/harness.h"
#include "core/picture.h"

namespace strata::bench {
namespace {

constexpr int kPicture = 480;   // pixels, square
constexpr int kCaption = 44;    // pixels below a row
constexpr int kTexture = 2048;  // of the checker layer
constexpr int kSquare = 16;     // texels of a field of the checker
const glm::dvec3 kDirections[] = {{0.4, -1, 0.35}, {-0.5, 1, 0.3}, {0.2, -0.4, 1}};
constexpr int kDirectionCount = 3;

struct Options {
  std::vector<std::string> meshes;
  std::string cache = "build/bench", out = "contact-sheet.svg";
  bool make_always = false, all = false;
};

// Fields of kSquare texels in turn dark and light; every eighth line of fields is tinted, so that one sees which way u and
// v run and how large 128 texels are.
std::vector<render::TileUpload> checker_tiles() {
  std::vector<render::TileUpload> tiles;
  for (std::uint16_t ty = 0; ty < kTexture / kTileSize; ++ty)
    for (std::uint16_t tx = 0; tx < kTexture / kTileSize; ++tx) {
      auto tile = std::make_shared<TileData>(ValueType::u8);
      for (int i = 0; i < kTexelsPerTile; ++i) {
        const int x = (tx * kTileSize + i % kTileSize) / kSquare, y = (ty * kTileSize + i / kTileSize) / kSquare;
        const bool is_light = (x + y) % 2 == 0;
        const std::uint32_t tint = x % 8 == 0 ? 2 : y % 8 == 0 ? 4 : 0;
        tile->write(i, tint + (is_light ? 1 : 0));
      }
      tiles.push_back({{tx, ty}, tile});
    }
  return tiles;
}

std::shared_ptr<const Palette> checker_palette() {
  auto palette = std::make_shared<Palette>();
  palette->mode = PaletteMode::categorical;
  palette->min = 0, palette->max = 5;
  palette->points = {{0, {70, 70, 74, 255}, ""},    {1, {232, 230, 224, 255}, ""}, {2, {150, 40, 40, 255}, ""},
                     {3, {240, 170, 160, 255}, ""}, {4, {40, 70, 150, 255}, ""},   {5, {165, 190, 240, 255}, ""}};
  return palette;
}

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) three = three << 8 | (i + k < bytes.size() ? bytes[i + k] : 0);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

std::string caption(const BenchMesh& mesh) {
  const auto& atlas = mesh.atlas;
  const double texels = atlas.coverage * atlas.lowest_resolution * atlas.lowest_resolution;
  char text[400];
  std::snprintf(text, sizeof text,
                "%zu triangles · %s texture coordinates · %d charts · %.1f %% of texels used · mean stretch %.2f · "
                "largest texel %.2f × the mean",
                mesh.geometry->triangle_count(), atlas.source == "file" ? "the file's" : "made", atlas.charts,
                100 * atlas.coverage, atlas.stretch_mean, atlas.texel_area_max * texels / mesh.area);
  return text;
}

// One row: the pictures of a model and its caption.
std::string row(render::Renderer& renderer, const BenchMesh& mesh, int top) {
  using namespace render;
  const auto model = await<ModelHandle>([&](auto done) { renderer.add_model({mesh.geometry, {}}, done); });
  const auto layer = await<LayerHandle>([&](auto done) { renderer.add_layer(model, ValueType::u8, kTexture, done); });
  await<void>([&](auto done) { renderer.write_tiles(layer, checker_tiles(), done); });
  const auto view = await<ViewHandle>([&](auto done) { renderer.add_view(model, done); });
  std::ostringstream svg;
  for (int i = 0; i < kDirectionCount; ++i) {
    FrameRequest request;
    request.view = view;
    request.camera = look_at(*mesh.geometry, kDirections[i], kPicture, kPicture);
    request.width = request.height = kPicture;
    request.layers = {{layer, checker_palette(), 1}};
    const Frame frame = await<Frame>([&](auto done) { renderer.draw(request, done); });
    const auto jpeg = encode_jpeg(frame.pixels, frame.width, frame.height, {85, true});
    svg << "<image x=\"" << i * kPicture << "\" y=\"" << top << "\" width=\"" << kPicture << "\" height=\"" << kPicture
        << "\" href=\"data:image/jpeg;base64," << base64(jpeg) << "\"/>\n";
  }
  const std::string name = std::filesystem::path(mesh.name).filename().string();
  svg << "<text x=\"8\" y=\"" << top + kPicture + 18 << "\" font-weight=\"bold\">" << escaped(name) << "</text>\n"
      << "<text x=\"8\" y=\"" << top + kPicture + 36 << "\">" << escaped(caption(mesh)) << "</text>\n";
  renderer.remove_model(model);
  return svg.str();
}

int run(const Options& options) {
  const auto renderer = start_renderer();
  std::string rows;
  int top = 0;
  for (const auto& name : options.all ? all_meshes() : options.meshes) {
    const BenchMesh mesh = load_bench_mesh(name, options.cache, options.make_always);
    std::printf("%s: %s\n", name.c_str(), caption(mesh).c_str());
    std::fflush(stdout);
    rows += row(*renderer, mesh, top);
    top += kPicture + kCaption;
  }
  std::ofstream out(options.out);
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << kDirectionCount * kPicture << "\" height=\"" << top
      << "\" font-family=\"sans-serif\" font-size=\"14\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
      << rows << "</svg>\n";
  out.close();
  if (!out) {
    std::fprintf(stderr, "strata-bench: cannot write %s\n", options.out.c_str());
    return 1;
  }
  return 0;
}

}  // namespace

Command add_sheet(CLI::App& app) {
  auto* command = app.add_subcommand("sheet", "A contact sheet of models under a checker layer, as SVG");
  auto options = std::make_shared<Options>();
  command->add_option("meshes", options->meshes, "pot, pot:N, presets or files");
  command->add_flag("--all", options->all, "Every mesh of the data folder, and the presets");
  command->add_option("-o,--out", options->out, "Where the sheet goes")->capture_default_str();
  command->add_flag("--make", options->make_always, "Never keep the file's own texture coordinates");
  command->add_option("--cache", options->cache, "Where generated meshes are kept")->capture_default_str();
  return [options] { return run(*options); };
}

}  // namespace strata::bench
