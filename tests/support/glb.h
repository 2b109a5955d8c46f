#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace strata::test {

// Builds glTF files step by step. Each `add` makes a buffer view and an accessor, and returns the
// number of the accessor.
class GltfBuilder {
 public:
  nlohmann::json json = {
      {"asset", {{"version", "2.0"}}},        {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},         {"nodes", {{{"mesh", 0}}}},
      {"accessors", nlohmann::json::array()}, {"bufferViews", nlohmann::json::array()}};

  template <class Number>
  int add(const std::vector<Number>& numbers, int component_type, const std::string& type,
          bool normalized = false) {
    static const std::map<std::string, int> components{
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
    const int view = add_view(numbers.data(), numbers.size() * sizeof(Number));
    json["accessors"].push_back({{"bufferView", view},
                                 {"componentType", component_type},
                                 {"count", numbers.size() / components.at(type)},
                                 {"type", type},
                                 {"normalized", normalized}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  int add_view(const void* data, std::size_t size) {
    binary_.resize((binary_.size() + 3) / 4 * 4);
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", size}});
    binary_.append(static_cast<const char*>(data), size);
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  std::string glb() const {
    std::string text = with_buffer({}).dump(), data = binary_;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4);
    std::string file = "glTF";
    word(file, 2);
    word(file, static_cast<std::uint32_t>(28 + text.size() + data.size()));
    word(file, static_cast<std::uint32_t>(text.size()));
    file += "JSON" + text;
    word(file, static_cast<std::uint32_t>(data.size()));
    return file + std::string("BIN\0", 4) + data;
  }
  // Returns the JSON of a file whose binary data is at `uri`: the name of a file or a data URI.
  std::string gltf(const std::string& uri) const { return with_buffer(uri).dump(); }
  const std::string& binary() const { return binary_; }

 private:
  nlohmann::json with_buffer(const std::string& uri) const {
    nlohmann::json copy = json;
    copy["buffers"] = {{{"byteLength", binary_.size()}}};
    if (!uri.empty()) copy["buffers"][0]["uri"] = uri;
    return copy;
  }
  static void word(std::string& file, std::uint32_t value) {
    file.append(reinterpret_cast<const char*>(&value), 4);
  }

  std::string binary_;
};

}  // namespace strata::test
