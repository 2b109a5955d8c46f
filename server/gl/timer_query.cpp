#include "gl/timer_query.h"

namespace strata::gl {

TimerQuery TimerQuery::create(std::string_view label) {
  GLuint id = 0;
  glCreateQueries(GL_TIME_ELAPSED, 1, &id);
  TimerQuery query;
  query.object_ = Object<Traits>(id);
  query.object_.label(label);
  return query;
}

double TimerQuery::elapsed_ms() const {
  GLuint64 elapsed_ns = 0;
  glGetQueryObjectui64v(object_.id(), GL_QUERY_RESULT, &elapsed_ns);
  return static_cast<double>(elapsed_ns) * 1e-6;
}

}  // namespace strata::gl
