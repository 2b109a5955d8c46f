#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/ids.h"
#include "room/listener.h"
#include "room/open/open_room.h"
#include "room/surface_images.h"

namespace strata::room {

class OpenRoom::SurfaceImagesPart final : public SurfaceImages {
 public:
  explicit SurfaceImagesPart(OpenRoom& room) : room_(room) {}
  std::vector<SurfaceImage> all() const override;
  Result<SurfaceImage> find(const std::string& ref) const override;
  Result<SurfaceImage> create(SurfaceImage image, std::span<const std::uint8_t> picture,
                              const store::IdempotentResponse<SurfaceImage>& answer) override;
  Result<SurfaceImage> update(const SurfaceImage& image,
                              const store::IdempotentResponse<SurfaceImage>& answer) override;
  Result<void> erase(SurfaceImageId id, const store::IdempotentResponse<>& answer) override;

  // Replaces the images of the room by the stored ones, and notifies listeners of each change. Runs
  // on the strand.
  void replace(const std::vector<SurfaceImage>& stored);

 private:
  void tell(Listener::LayerChange change, const SurfaceImage& image);  // on the strand

  OpenRoom& room_;
};

}  // namespace strata::room
