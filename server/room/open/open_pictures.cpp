// Images for scripts. Each image is drawn once, in a separate view.
#include <algorithm>
#include <cmath>
#include <optional>

#include "domain/people/question.h"
#include "media/picture_writer.h"
#include "room/caches/await.h"
#include "room/open/open_pictures.h"
#include "room/pipeline/gpu_problem.h"
#include "room/pipeline/provisional.h"
#include "store/journal/journal_reads.h"

namespace strata::room {
namespace {

// Larger images are drawn in bands of about this many pixels. A band takes a tenth of a second on a
// CPU, and 32 MB for the buffers of a view.
constexpr int kPixelsOfBand = 1 << 21;
// Rows of the window above and below a band. They are drawn with the band and then left out. They
// are necessary because a pixel depends on its neighbors (outlines), and drawn features are wider
// than their line.
constexpr int kRowsAround = 16;
constexpr int kRowsEncoded = 32;

// Removes the GPU objects of an image, also on failure.
struct Borrowed {
  render::Renderer& renderer;
  render::ViewHandle view = 0;
  std::vector<render::LayerHandle> layers;
  ~Borrowed() {
    if (view) renderer.remove_view(view);
    for (auto layer : layers) renderer.remove_layer(layer);
  }
};

}  // namespace

Result<std::vector<std::uint8_t>> Pictures::draw_file(const PictureRequest& request,
                                                      const Camera& camera, PictureFormat format,
                                                      JpegSettings jpeg) {
  std::optional<PictureWriter> writer;
  const PicturePart part{camera};
  auto seen = draw(request, {&part, 1}, [&](std::size_t, const PictureBand& band) -> Result<void> {
    if (!writer) writer.emplace(format, band.width, band.height, jpeg);
    // Encodes a few rows at a time, so the server can work on other questions in between.
    const std::size_t row = band.rgba.size() / static_cast<std::size_t>(band.rows);
    const QuestionTurn turn;
    for (int top = 0; top < band.rows; top += kRowsEncoded) {
      turn.check();
      const auto rows = static_cast<std::size_t>(std::min(kRowsEncoded, band.rows - top));
      writer->put(band.rgba.subspan(row * static_cast<std::size_t>(top), row * rows));
    }
    return {};
  });
  if (!seen) return tl::unexpected(seen.error());
  return writer->finish();
}

Result<void> OpenRoom::PicturesPart::draw(const PictureRequest& picture,
                                          std::span<const PicturePart> parts,
                                          const SeePicture& see) {
  room_.touch();
  const Visibility sight = sight_of(picture.seen_by);
  std::vector<LayerState> shown;
  if (picture.layers) {
    for (const auto& ref : *picture.layers) {
      auto found = STRATA_TRY(room_.state(ref));
      shown.push_back(std::move(found));
    }
  } else {
    for (auto& candidate : room_.layer_states())
      if (picture.shown.of(candidate.layer.id).visible.value_or(candidate.layer.visible))
        shown.push_back(std::move(candidate));
    sort_as_shown(shown, picture.shown);
  }
  STRATA_TRY(room_.check_durable(picture.at));

  Borrowed borrowed{room_.services_.renderer, 0, {}};
  const auto model = room_.model_handle();
  render::FrameRequest request;
  std::vector<LayerFeatures> marked;
  const auto borrow = [&](ValueType type, int resolution,
                          TileMap tiles) -> Result<render::LayerHandle> {
    auto mirror = std::make_shared<TileMirror>(type, resolution);
    mirror->assign(std::move(tiles), *picture.at);
    auto copy = add_layer(room_.services_.renderer, model, std::move(mirror));
    if (!copy) return tl::unexpected(room_.gpu_problem(copy.error()));
    borrowed.layers.push_back(*copy);
    return *copy;
  };
  for (const auto& item : shown) {
    render::LayerStyle style{item.handles.content, item.palette,
                             static_cast<float>(item.layer.opacity), item.layer.blend};
    std::optional<render::LayerHandle> waiting = item.waiting();
    if (picture.at) {
      auto past = STRATA_TRY(room_.services_.store.journal().load_tiles(item.layer, picture.at));
      auto content =
          STRATA_TRY(borrow(item.layer.type, item.layer.resolution, std::move(past.tiles)));
      style.layer = content;
      waiting.reset();
      if (const auto then = picture.provisional.find(item.layer.id);
          then != picture.provisional.end()) {
        auto features = STRATA_TRY(borrow(ValueType::u8, item.layer.resolution, then->second));
        waiting = features;
      }
    }
    const LayerView& mine = picture.shown.of(item.layer.id);
    if (mine.palette) style.palette = std::make_shared<const Palette>(*mine.palette);
    const auto highlight =
        mine.highlight ? std::make_shared<const Highlight>(*mine.highlight) : nullptr;
    if (item.layer.table && RecordColors::needs_records(*style.palette, highlight)) {
      auto made = STRATA_TRY(
          room_.record_colors_->make({*item.layer.table, sight, style.palette, highlight}));
      style.palette = std::move(made);
    }
    if (mine.opacity) style.opacity = static_cast<float>(*mine.opacity);
    add_styles(style, waiting, request.style.layers);
    if (!item.layer.table || !picture.marks) continue;
    // An image of the newest edit shows the present records, also if they have changed since then.
    const bool is_past = picture.at && *picture.at < room_.durable_;
    auto features = is_past ? room_.record_features_->when(*item.layer.table, sight, *picture.at)
                            : room_.record_features_->newest(*item.layer.table, sight);
    if (!features) return tl::unexpected(features.error());
    if (*features) marked.push_back({std::move(*features), style.palette, style.opacity});
  }
  auto view = await<render::ViewHandle>(
      [&](auto done) { room_.services_.renderer.add_view(model, std::move(done)); });
  if (!view) return tl::unexpected(room_.gpu_problem(view.error()));
  borrowed.view = request.view = *view;
  auto images = room_.surface_image_cache_->wait(picture.shown.images);
  if (!images) return tl::unexpected(room_.gpu_problem(images.error()));
  request.style.images = std::move(*images);
  request.style.light = picture.shown.light;
  if (picture.on_floor) request.style.contact_shadow = room_.contact_shadow(picture.shown.light);
  request.style.background = picture.shown.background;
  request.style.features = show_features(marked);
  request.samples = picture.samples;
  request.samples_time = picture.samples_time;
  request.style.unit_mm = room_.model().metres() * 1000;
  for (std::size_t i = 0; i < parts.size(); ++i)
    STRATA_TRY(draw_in_bands(request, parts[i], i, see));
  return {};
}

Result<void> OpenRoom::PicturesPart::draw_in_bands(render::FrameRequest request,
                                                   const PicturePart& part, std::size_t number,
                                                   const SeePicture& see) {
  const Camera& camera = part.camera;
  STRATA_TRY(validate(camera));
  const auto pixels = [&](int window) {
    return static_cast<int>(std::lround(window * part.pixels));
  };
  const int width = pixels(camera.width), height = pixels(camera.height);
  if (width < 1 || height < 1 || width > kMaxViewSize || height > kMaxViewSize)
    return fail(
        ErrorCode::invalid, "Size out of range",
        "Each side of a picture must be 1 to " + std::to_string(kMaxViewSize) + " pixels long.",
        "width");
  // A band consists of whole rows of the camera's window, so a camera with fewer rows can draw it.
  const bool is_large = static_cast<std::int64_t>(width) * height > kPixelsOfBand;
  const int most = static_cast<int>(kPixelsOfBand / (width * std::max(part.pixels, 1e-3)));
  const int step = is_large ? std::clamp(most, 1, camera.height) : camera.height;
  for (int top = 0; top < camera.height; top += step) {
    room_.touch();
    check_question();
    const int end = std::min(top + step, camera.height);
    const int first = is_large ? std::max(0, top - kRowsAround) : 0;
    const int last = is_large ? std::min(camera.height, end + kRowsAround) : camera.height;
    request.large = is_large || request.samples > 1;
    request.camera = is_large ? camera_of_rows(camera, first, last - first) : camera;
    request.width = width;
    request.height = pixels(last) - pixels(first);
    request.background_rows = glm::vec2(first, last) / static_cast<float>(camera.height);
    const auto frame = await_for_question<render::SharedFrame>(
        [&](auto done) { room_.services_.renderer.draw(request, std::move(done)); });
    if (!frame) return tl::unexpected(room_.gpu_problem(frame.error()));
    const std::size_t row = std::size_t{4} * static_cast<std::size_t>(width);
    const int rows = pixels(end) - pixels(top);
    const std::span<const std::uint8_t> all((*frame)->pixels);
    const auto band = all.subspan(row * static_cast<std::size_t>(pixels(top) - pixels(first)),
                                  row * static_cast<std::size_t>(rows));
    if (rows == 0) continue;
    STRATA_TRY(see(number, {width, height, pixels(top), rows, band}));
  }
  return {};
}

Result<std::vector<std::optional<std::uint32_t>>> OpenRoom::PicturesPart::seen_keys(
    const std::string& layer, const Camera& camera, int columns, int rows, At at) {
  room_.touch();
  auto views = STRATA_TRY(room_.layer_views({layer}, at));
  return query::seen_keys(*room_.surface_lookup_->tree(), room_.geometry_->origin, camera, columns,
                          rows, views.front());
}

Result<std::vector<query::SeenLayer>> OpenRoom::PicturesPart::seen_layers(
    const std::vector<std::string>& layers, const std::vector<query::LayerCover>& covers,
    const Camera& camera, int columns, int rows, At at) {
  room_.touch();
  auto views = STRATA_TRY(room_.layer_views(layers, at));
  return query::seen_layers(*room_.surface_lookup_->tree(), room_.geometry_->origin, camera,
                            columns, rows, views, covers);
}

}  // namespace strata::room
