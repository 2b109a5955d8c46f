#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "mesh/io/input_files.h"

namespace strata::mesh {

// The parts of a glTF 2.0 file (Khronos, "glTF 2.0 Specification"): its JSON and its buffers. The
// buffers are in the GLB, in separate files or in data URIs, or are compressed with
// EXT_meshopt_compression or KHR_meshopt_compression. Every offset, count and index is checked
// here. Data are copied only if necessary. Errors are those of `refuse_file`. Can be used on any
// thread, but only on one thread at a time.
class GltfDocument {
 public:
  static Result<GltfDocument> open(const InputFiles& files);

  const nlohmann::json& root() const { return json_; }

  // Returns an element of one of the top-level arrays.
  Result<const nlohmann::json*> element(const char* array, std::uint64_t index) const;

  // The decompressed bytes of a buffer view. They are valid for the lifetime of the document.
  struct View {
    std::span<const std::uint8_t> bytes;
    std::uint64_t stride = 0;  // 0: elements follow each other
  };
  Result<View> view(std::uint64_t index);

  // The declaration of an accessor's values. It also exists if a compression extension stores the
  // values. `what` is the name of the values in error messages.
  struct Form {
    std::uint64_t count = 0;
    int component_type = 0, components = 0;
    bool normalized = false;
  };
  Result<Form> form(std::uint64_t accessor, const std::string& what) const;

  // The values of an accessor as real numbers, `components` numbers per value. Normalized integers
  // become 0…1 or −1…1. `normalize` applies this to all integers. Sparse values are applied.
  struct Values {
    std::uint64_t count = 0;
    int components = 0;
    std::vector<float> numbers;
  };
  Result<Values> values(std::uint64_t accessor, const std::string& what, bool normalize = false);
  Result<std::vector<std::uint32_t>> indices(std::uint64_t accessor);

  // A copy of an image's encoded bytes. It is empty if the file was not uploaded.
  struct Image {
    std::string name;
    std::vector<std::uint8_t> bytes;
    bool missing = false;
  };
  Result<Image> image(std::uint64_t index);

  bool uses_required(const std::string& extension) const;

 private:
  explicit GltfDocument(const InputFiles& files) : files_(&files) {}
  Result<void> read_container();
  Result<void> check_version_and_extensions() const;
  Result<std::span<const std::uint8_t>> buffer(std::uint64_t index);
  Result<View> decompress(const nlohmann::json& view, const nlohmann::json& extension,
                          const std::string& extension_name, std::uint64_t index);
  struct Layout {
    Form form;
    std::span<const std::uint8_t> bytes;  // empty: all zeros
    std::uint64_t stride = 0;
  };
  Result<Layout> layout(std::uint64_t accessor, const std::string& what);
  // Calls put(number of the element, its bytes) for the elements of the buffer view, and then for
  // the sparse elements.
  template <class Put>
  Result<void> for_each_element(std::uint64_t accessor, const std::string& what,
                                const Layout& layout, Put&& put);

  const InputFiles* files_;
  nlohmann::json json_;
  std::span<const std::uint8_t> glb_binary_;
  bool has_glb_binary_ = false;
  std::map<std::uint64_t, std::vector<std::uint8_t>> decoded_buffers_, decoded_views_;
  std::uint64_t decoded_bytes_ = 0;  // of decoded_views_
};

// Functions that read members of a glTF JSON object. A missing member has the default value. A
// member of the wrong type is refused.
Result<std::uint64_t> whole_number(const nlohmann::json& object, const char* name,
                                   std::uint64_t otherwise);
// refuses a missing member
Result<std::uint64_t> whole_number(const nlohmann::json& object, const char* name);
Result<std::vector<double>> real_numbers(const nlohmann::json& object, const char* name,
                                         const std::vector<double>& otherwise);
std::string text_of(const nlohmann::json& object, const char* name);
// Returns the member if it is an object. Otherwise returns an empty object.
const nlohmann::json& object_in(const nlohmann::json& object, const char* name);

}  // namespace strata::mesh
