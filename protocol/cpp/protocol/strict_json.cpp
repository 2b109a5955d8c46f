#include "protocol/strict_json.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "protocol/fast_json.h"

namespace strata::protocol {
namespace {

using nlohmann::json;

// Builds the value event by event. Checks the depth and duplicates before it allocates memory for
// them.
class StrictBuilder : public nlohmann::json_sax<json> {
 public:
  StrictBuilder(int max_depth, const ListLimits* lists)
      : max_depth_(max_depth), root_lists_(lists) {}

  json take() { return std::move(root_); }
  Error take_problem() { return std::move(problem_); }

  bool null() override { return put(nullptr); }
  bool boolean(bool value) override { return put(value); }
  bool number_integer(number_integer_t value) override { return put(value); }
  bool number_unsigned(number_unsigned_t value) override { return put(value); }
  bool number_float(number_float_t value, const string_t& text) override {
    if (!std::isfinite(value))
      return refuse(ErrorCode::invalid, "Number not usable",
                    "The number " + text.substr(0, 40) + " is too large.");
    return put(value);
  }
  bool string(string_t& text) override {
    if (has_nul(text)) return false;
    return put(std::move(text));
  }
  bool binary(binary_t&) override { return false; }  // impossible in a text

  bool start_object(std::size_t) override { return has_room() && open(json::object()); }
  bool key(string_t& name) override {
    if (has_nul(name)) return false;
    if (open_.back()->contains(name))
      return refuse(ErrorCode::invalid, "Member given twice",
                    "The member \"" + name.substr(0, 100) + "\" stands twice in one object.");
    key_ = std::move(name);
    return true;
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override {
    if (!has_room()) return false;
    json list = json::array();
    list.get_ref<json::array_t&>().reserve(4);  // most lists are short: points, colors
    return open(std::move(list));
  }
  bool end_array() override { return close(); }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    if (error.id == 406)
      return refuse(ErrorCode::invalid, "Number not usable",
                    "A number near byte " + std::to_string(position) + " is too large.");
    return refuse(ErrorCode::malformed, "Malformed JSON",
                  "The text stops being JSON near byte " + std::to_string(position) + ".");
  }

 private:
  json* add(json&& value) {
    if (open_.empty()) return &(root_ = std::move(value));
    json& parent = *open_.back();
    if (parent.is_array()) {
      parent.push_back(std::move(value));
      return &parent.back();
    }
    return &(parent[key_] = std::move(value));
  }
  bool put(json&& value) {
    if (!has_room()) return false;
    add(std::move(value));
    return true;
  }
  // Returns whether the open list, if there is one, may get another item.
  bool has_room() {
    if (open_.empty() || !open_.back()->is_array()) return true;
    const ListLimits* limits = lists_.back();
    if (!limits || !limits->most || open_.back()->size() < *limits->most) return true;
    refuse(ErrorCode::invalid, "Value not allowed", "It must be " + limits->wanted + ".");
    for (std::size_t i = 1; i < steps_.size(); ++i)
      problem_.field +=
          (steps_[i].starts_with('[') || problem_.field.empty() ? "" : ".") + steps_[i];
    return false;
  }
  // Returns the limits of the object or list that is opened next.
  const ListLimits* next_lists() const {
    if (open_.empty()) return root_lists_;
    const ListLimits* limits = lists_.back();
    if (!limits) return nullptr;
    if (open_.back()->is_array()) return limits->items.get();
    const auto member = limits->members.find(key_);
    return member == limits->members.end() ? nullptr : member->second.get();
  }
  // A pointer to an open value stays valid because only the children of this value grow while it is
  // open.
  bool open(json&& container) {
    if (static_cast<int>(open_.size()) >= max_depth_)
      return refuse(
          ErrorCode::invalid, "Nested too deeply",
          "At most " + std::to_string(max_depth_) + " objects and lists may lie in each other.");
    lists_.push_back(next_lists());
    if (open_.empty())
      steps_.emplace_back("-");
    else
      steps_.push_back(open_.back()->is_array() ? "[" + std::to_string(open_.back()->size()) + "]"
                                                : key_);
    open_.push_back(add(std::move(container)));
    return true;
  }
  bool close() {
    open_.pop_back();
    lists_.pop_back();
    steps_.pop_back();
    return true;
  }
  bool has_nul(const std::string& text) {
    if (text.find('\0') == std::string::npos) return false;
    refuse(ErrorCode::invalid, "Text not usable",
           "A text holds the character U+0000, which cannot be stored.");
    return true;
  }
  bool refuse(ErrorCode code, const char* title, std::string detail) {
    problem_ = Error{code, title, std::move(detail), {}};
    return false;
  }

  int max_depth_;
  json root_;
  const ListLimits* root_lists_;
  std::vector<json*> open_;
  std::vector<const ListLimits*> lists_;  // of each open value; null: no limits
  std::vector<std::string> steps_;        // path element of each open value
  std::string key_;
  Error problem_;
};

}  // namespace

Result<json> parse_json(std::string_view text, const JsonLimits& limits) {
  if (text.size() > limits.max_bytes)
    return fail(ErrorCode::too_large, "Too much at once",
                "At most " + std::to_string(limits.max_bytes) +
                    " bytes of JSON are taken; these are " + std::to_string(text.size()) + ".");
  // For a shorter text, it is faster to build and validate the value than to scan the text first.
  constexpr std::size_t kLong = 64 * 1024;
  if (limits.lists && text.size() >= kLong)
    if (const auto too_long = find_long_list(text, *limits.lists))
      return fail(ErrorCode::invalid, "Value not allowed", "It must be " + too_long->wanted + ".",
                  too_long->path);
  if (auto value = read_json_fast(text, limits.max_depth)) return std::move(*value);
  StrictBuilder builder(limits.max_depth, limits.lists);
  if (!json::sax_parse(text.begin(), text.end(), &builder))
    return tl::unexpected<Error>(builder.take_problem());
  return builder.take();
}

}  // namespace strata::protocol
