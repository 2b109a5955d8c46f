// Rendered pictures for a script: a view of their own, drawn once each.
#include <cmath>

#include "room/await.h"
#include "room/gpu_problem.h"
#include "room/open_room.h"
#include "room/provisional.h"

namespace strata::room {
namespace {

// Removes what a picture put on the GPU, however it ends.
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

Result<render::Frame> Room::picture(const PictureRequest& request, const Camera& camera) {
  render::Frame only;
  const PicturePart part{camera};
  auto seen = pictures(request, {&part, 1}, [&](std::size_t, const render::Frame& picture) -> Result<void> {
    only = picture;
    return {};
  });
  if (!seen) return tl::unexpected(seen.error());
  return only;
}

Result<void> OpenRoom::pictures(const PictureRequest& asked, std::span<const PicturePart> parts,
                                const SeePicture& see) {
  touch();
  const Visibility sight = sight_of(asked.seen_by);
  std::vector<LayerState> shown;
  if (asked.layers) {
    for (const auto& ref : *asked.layers) {
      auto found = state(ref);
      if (!found) return tl::unexpected(found.error());
      shown.push_back(std::move(*found));
    }
  } else {
    for (auto& candidate : layer_states())
      if (asked.shown.of(candidate.layer.id).visible.value_or(candidate.layer.visible))
        shown.push_back(std::move(candidate));
  }
  if (asked.at && *asked.at > durable_)
    return fail(422, "Sequence not reached",
                "The newest durable edit of this model is " + std::to_string(durable_) + ".", "at");

  Borrowed borrowed{parts_.renderer, 0, {}};
  const auto model = model_handle();
  render::FrameRequest request;
  std::vector<LayerMarks> marked;
  const auto borrow = [&](ValueType type, int resolution, TileMap tiles) -> Result<render::LayerHandle> {
    auto mirror = std::make_shared<TileMirror>(type, resolution);
    mirror->assign(std::move(tiles), *asked.at);
    auto copy = add_layer(parts_.renderer, model, std::move(mirror));
    if (!copy) return tl::unexpected(gpu_problem(copy.error()));
    borrowed.layers.push_back(*copy);
    return *copy;
  };
  for (const auto& item : shown) {
    render::LayerStyle style{item.handles.content, item.palette, static_cast<float>(item.layer.opacity)};
    std::optional<render::LayerHandle> waiting = item.waiting();
    if (asked.at) {
      auto past = parts_.store.load_tiles(item.layer, asked.at);
      if (!past) return tl::unexpected(past.error());
      auto content = borrow(item.layer.type, item.layer.resolution, std::move(past->tiles));
      if (!content) return tl::unexpected(content.error());
      style.layer = *content;
      waiting.reset();
      if (const auto then = asked.provisional.find(item.layer.id); then != asked.provisional.end()) {
        auto marks = borrow(ValueType::u8, item.layer.resolution, then->second);
        if (!marks) return tl::unexpected(marks.error());
        waiting = *marks;
      }
    }
    const LayerView& mine = asked.shown.of(item.layer.id);
    if (mine.palette) style.palette = std::make_shared<const Palette>(*mine.palette);
    const auto highlight = mine.highlight ? std::make_shared<const Highlight>(*mine.highlight) : nullptr;
    if (item.layer.table && RecordColors::needs_records(*style.palette, highlight)) {
      auto made = record_colors_->make({*item.layer.table, sight, style.palette, highlight});
      if (!made) return tl::unexpected(made.error());
      style.palette = std::move(*made);
    }
    if (mine.opacity) style.opacity = static_cast<float>(*mine.opacity);
    add_styles(style, waiting, request.layers);
    if (!item.layer.table) continue;
    auto marks = asked.at ? record_marks_->when(*item.layer.table, sight, *asked.at)
                          : record_marks_->newest(*item.layer.table, sight);
    if (!marks) return tl::unexpected(marks.error());
    if (*marks) marked.push_back({std::move(*marks), style.palette, style.opacity});
  }
  auto view = await<render::ViewHandle>([&](auto done) { parts_.renderer.add_view(model, std::move(done)); });
  if (!view) return tl::unexpected(gpu_problem(view.error()));
  borrowed.view = request.view = *view;
  auto looks = look_shelf_->wait(asked.shown.looks);
  if (!looks) return tl::unexpected(gpu_problem(looks.error()));
  request.looks = std::move(*looks);
  request.light = asked.shown.light;
  request.background = asked.shown.background;
  request.marks = show_marks(marked);
  request.unit_mm = this->model().metres() * 1000;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    touch();
    request.camera = parts[i].camera;
    request.width = static_cast<int>(std::lround(parts[i].camera.width * parts[i].pixels));
    request.height = static_cast<int>(std::lround(parts[i].camera.height * parts[i].pixels));
    auto frame = await<render::SharedFrame>([&](auto done) { parts_.renderer.draw(request, std::move(done)); });
    if (!frame) return tl::unexpected(gpu_problem(frame.error()));
    if (auto seen = see(i, **frame); !seen) return seen;
  }
  return {};
}

}  // namespace strata::room
