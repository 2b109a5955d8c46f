#pragma once

#include "gl/object.h"

namespace strata::gl {

// Measures the GPU time between `begin` and `end`. Only one timer may run at a time.
class TimerQuery {
 public:
  TimerQuery() = default;
  static TimerQuery create(std::string_view label);

  explicit operator bool() const { return static_cast<bool>(object_); }
  void begin() const { glBeginQuery(GL_TIME_ELAPSED, object_.id()); }
  void end() const { glEndQuery(GL_TIME_ELAPSED); }
  // Waits for the result if necessary.
  double elapsed_ms() const;

 private:
  struct Traits {
    static constexpr GLenum kIdentifier = GL_QUERY;
    static void destroy(GLuint id) { glDeleteQueries(1, &id); }
  };
  Object<Traits> object_;
};

}  // namespace strata::gl
