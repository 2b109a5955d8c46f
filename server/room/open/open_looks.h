#pragma once

#include <span>
#include <string>
#include <vector>

#include "room/listener.h"
#include "room/looks.h"
#include "room/open/open_room.h"

namespace strata::room {

class OpenRoom::LooksPart final : public Looks {
 public:
  explicit LooksPart(OpenRoom& room) : room_(room) {}
  std::vector<Look> all() const override;
  Result<Look> find(const std::string& ref) const override;
  Result<Look> create(Look look, std::span<const std::uint8_t> picture,
                      const store::FirstAnswer<Look>& answer) override;
  Result<Look> update(const Look& look, const store::FirstAnswer<Look>& answer) override;
  Result<void> erase(std::int64_t id, const store::FirstAnswer<>& answer) override;

 private:
  void tell(Listener::LayerChange change, const Look& look);

  OpenRoom& room_;
};

}  // namespace strata::room
