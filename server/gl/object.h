#pragma once

#include <epoxy/gl.h>

#include <string_view>
#include <utility>

namespace strata::gl {

// The only owner of a GL object. Movable, not copyable. The id 0 is the empty, moved-from state.
// `Traits` has `void destroy(GLuint)` and `kIdentifier`, the kind of the object for debug labels.
// GPU thread only.
template <class Traits>
class Object {
 public:
  Object() = default;
  explicit Object(GLuint id) : id_(id) {}
  Object(Object&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    if (this != &other) {
      reset();
      id_ = std::exchange(other.id_, 0);
    }
    return *this;
  }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  ~Object() { reset(); }

  GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }
  void reset() {
    if (id_ != 0) Traits::destroy(std::exchange(id_, 0));
  }
  void label(std::string_view text) const {
    glObjectLabel(Traits::kIdentifier, id_, static_cast<GLsizei>(text.size()), text.data());
  }

 private:
  GLuint id_ = 0;
};

}  // namespace strata::gl
