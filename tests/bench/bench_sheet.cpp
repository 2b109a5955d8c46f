// Draws a contact sheet, an SVG file with JPEG images that any browser can show. It shows each
// model under a checker layer, as the renderer draws it, for a visual check of seams, distortion
// and texel density.
#include <cmath>
#include <fstream>
#include <sstream>

#include "bench/bench_commands.h"
#include "bench/bench_mesh.h"
#include "bench/harness.h"
#include "media/picture.h"
#include "mesh/texture/texture_sampler.h"

namespace strata::bench {
namespace {

constexpr int kPicture = 480;  // in pixels, square
constexpr int kFiner = 2;      // drawn larger by this factor to reduce aliasing of distant squares
constexpr int kCaption = 62;   // pixels below a row
constexpr int kHeader = 54;
constexpr int kTexture = 2048;  // texels along one side of the checker layer
constexpr int kSquare = 16;     // texels along one side of a checker square
// Directions of the views: from the front right, from the back left, and from above. The axes are
// right, front and up.
const glm::dvec3 kDirections[] = {{0.5, 1, 0.45}, {-0.5, -1, 0.45}, {0.15, 0.45, 1}};
constexpr int kDirectionCount = 3;
constexpr double kAboveFlat = 1.1;  // a lower camera shows little of a terrain

struct Options {
  std::vector<std::string> meshes;
  BenchMeshOptions load;
  std::string out = "contact-sheet.svg";
  bool all = false;
};

// Returns squares of kSquare texels, alternately dark and light. Every eighth row and column is
// tinted, to show the directions of u and v and a length of 128 texels.
std::vector<render::TileUpload> checker_tiles() {
  std::vector<render::TileUpload> tiles;
  for (std::uint16_t ty = 0; ty < kTexture / kTileSize; ++ty)
    for (std::uint16_t tx = 0; tx < kTexture / kTileSize; ++tx) {
      auto tile = std::make_shared<TileData>(ValueType::u8);
      for (int i = 0; i < kTexelsPerTile; ++i) {
        const int x = (tx * kTileSize + i % kTileSize) / kSquare,
                  y = (ty * kTileSize + i / kTileSize) / kSquare;
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
  palette->points = {{0, {112, 112, 118, 255}, ""}, {1, {242, 240, 234, 255}, ""},
                     {2, {170, 40, 40, 255}, ""},   {3, {240, 170, 160, 255}, ""},
                     {4, {40, 70, 170, 255}, ""},   {5, {165, 190, 240, 255}, ""}};
  return palette;
}

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? bytes[i + k] : 0);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

std::string text_at(int x, int y, const std::string& text, const char* style = "") {
  return "<text x=\"" + std::to_string(x) + "\" y=\"" + std::to_string(y) + "\"" + style + ">" +
         escaped(text) + "</text>\n";
}

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

// Returns a caption with the size of the model and of a checker square.
std::string size_caption(const BenchMesh& mesh) {
  const glm::dvec3 extent = mesh.geometry->box_max - mesh.geometry->box_min;
  const double texels = mesh.atlas.coverage * kTexture * kTexture;
  const std::string unit = mesh.unit.empty() ? "units" : mesh.unit;
  return formatted("%zu triangles · %.5g × %.5g × %.5g %s, %s up · a field is %.3g %s wide",
                   mesh.geometry->triangle_count(), extent.x, extent.y, extent.z, unit.c_str(),
                   mesh.standing.up.c_str(), kSquare * std::sqrt(mesh.area / texels), unit.c_str());
}

std::string atlas_caption(const BenchMesh& mesh) {
  const auto& atlas = mesh.atlas;
  const double texels = atlas.coverage * atlas.lowest_resolution * atlas.lowest_resolution;
  return formatted(
      "%s texture coordinates · %d chart%s · %.1f %% of texels used · mean stretch %.2f · largest texel %.2f × the mean",
      atlas.source == "file" ? "the file's" : "made", atlas.charts, atlas.charts == 1 ? "" : "s",
      100 * atlas.coverage, atlas.stretch_mean, atlas.texel_area_max * texels / mesh.area);
}

std::string header() {
  return text_at(8, 22, "From the right of the front, from the left of the back, from above.",
                 " font-weight=\"bold\"") +
         text_at(
             8, 42,
             formatted(
                 "Fields of %d × %d texels of a layer of %d². Red lines run along v, blue ones along u, %d texels "
                 "apart. Good: fields of one size all over, and square; where lines break, charts meet.",
                 kSquare, kSquare, kTexture, 8 * kSquare));
}

bool lies_flat(const BenchMesh& mesh) {
  const glm::dvec3 extent = mesh.geometry->box_max - mesh.geometry->box_min;
  const int up = mesh.standing.up == "x" ? 0 : mesh.standing.up == "y" ? 1 : 2;
  return extent[up] < 0.3 * std::max(extent[(up + 1) % 3], extent[(up + 2) % 3]);
}

// Draws one row: the images of a model and their caption.
std::string row(render::Renderer& renderer, const BenchMesh& mesh, int top) {
  using namespace render;
  const auto model = await<ModelHandle>([&](auto done) {
    renderer.add_model({mesh.geometry, {}}, done);
  });
  const auto layer = await<LayerHandle>(
      [&](auto done) { renderer.add_layer(model, ValueType::u8, kTexture, done); });
  await<void>([&](auto done) { renderer.write_tiles(layer, checker_tiles(), done); });
  const auto view = await<ViewHandle>([&](auto done) { renderer.add_view(model, done); });
  std::ostringstream svg;
  for (int i = 0; i < kDirectionCount; ++i) {
    FrameRequest request;
    request.view = view;
    request.width = request.height = kPicture * kFiner;
    glm::dvec3 from = kDirections[i];
    if (lies_flat(mesh)) from.z = std::max(from.z, kAboveFlat);
    request.camera = fitted_camera(*mesh.geometry, mesh.standing, from, request.width);
    request.style.layers = {{layer, checker_palette(), 1}};
    const auto drawn = await<SharedFrame>([&](auto done) { renderer.draw(request, done); });
    const Frame& frame = *drawn;
    static_assert(kFiner == 2);
    const Picture picture = mesh::halve({frame.width, frame.height, frame.pixels});
    const auto jpeg = encode_jpeg(picture.rgba, picture.width, picture.height, {85, true});
    svg << "<image x=\"" << i * kPicture << "\" y=\"" << top << "\" width=\"" << kPicture
        << "\" height=\"" << kPicture << "\" href=\"data:image/jpeg;base64," << base64(jpeg)
        << "\"/>\n";
  }
  svg << text_at(8, top + kPicture + 18, mesh_title(mesh.name), " font-weight=\"bold\"")
      << text_at(8, top + kPicture + 36, size_caption(mesh))
      << text_at(8, top + kPicture + 53, atlas_caption(mesh));
  renderer.remove_model(model);
  return svg.str();
}

int run(const Options& options) {
  const auto renderer = start_renderer();
  std::string rows, refused;
  int top = kHeader;
  for (const auto& name : options.all ? must(all_meshes()) : options.meshes) {
    const auto mesh = load_bench_mesh(name, options.load);
    const std::string said = mesh_title(name) + (mesh ? ": " + atlas_caption(*mesh)
                                                      : " is not shown: " + mesh.error().detail);
    std::printf("%s\n", said.c_str());
    std::fflush(stdout);
    if (mesh) {
      rows += row(*renderer, *mesh, top);
      top += kPicture + kCaption;
    } else {
      refused += said + "\n";
    }
  }
  std::istringstream lines(refused);
  for (std::string line; std::getline(lines, line); top += 18)
    rows += text_at(8, top + 18, line, " font-size=\"12\"");
  std::ofstream out(options.out);
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << kDirectionCount * kPicture
      << "\" height=\"" << top + 18
      << "\" font-family=\"sans-serif\" font-size=\"14\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
      << header() << rows << "</svg>\n";
  out.close();
  if (!out) {
    std::fprintf(stderr, "strata-bench: cannot write %s\n", options.out.c_str());
    return 1;
  }
  return options.all || refused.empty() ? 0 : 1;
}

}  // namespace

Command add_sheet(CLI::App& app) {
  auto* command =
      app.add_subcommand("sheet", "A contact sheet of models under a checker layer, as SVG");
  auto options = std::make_shared<Options>();
  command->add_option("meshes", options->meshes,
                      "pot, pot:N, presets or files that an import takes");
  command->add_flag(
      "--all", options->all,
      "Every mesh of the data folder, and the presets; those that are refused are named");
  command->add_option("-o,--out", options->out, "Where the sheet goes")->capture_default_str();
  command->add_flag("--make", options->load.make_always,
                    "Never keep the file's own texture coordinates");
  command
      ->add_option("--up", options->load.up, "The axis that points up, of files that cannot say it")
      ->check(CLI::IsMember({"x", "y", "z"}));
  command->add_option("--cache", options->load.cache, "Where generated meshes are kept")
      ->capture_default_str();
  return [options] { return run(*options); };
}

}  // namespace strata::bench
