#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <numeric>
#include <thread>
#include <typeinfo>

#include "gl/buffer.h"
#include "gl/debug_messages.h"
#include "gl/egl_context.h"
#include "gl/fence.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/readback.h"
#include "gl/texture.h"
#include "gl/timer_query.h"
#include "gl/vertex_array.h"
#include "support/shader_dirs.h"

namespace strata::gl {
namespace {

class GlWrapper : public testing::Test {
 protected:
  void SetUp() override {
    auto context = EglContext::create({.debug = true});
    ASSERT_TRUE(context) << context.error().detail;
    context_ = std::move(*context);
    messages_.install();
  }
  void TearDown() override {
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    EXPECT_EQ(messages_.errors(), 0);
  }
  DebugMessages messages_;
  EglContext context_;
};

#ifndef __SANITIZE_THREAD__
// A thread sees the result of another thread and destroys the mutex, which the other thread still
// holds. llvmpipe frees its fences in this way. See mutex_destruction.cpp.
TEST(MutexDestruction, waits_for_the_thread_inside_the_mutex) {
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  std::atomic<bool> complete = false, left = false;
  std::jthread drawing([&] {
    pthread_mutex_lock(&mutex);
    complete = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    left = true;
    pthread_mutex_unlock(&mutex);
  });
  while (!complete) std::this_thread::yield();
  EXPECT_EQ(pthread_mutex_destroy(&mutex), 0);
  EXPECT_TRUE(left);
}

TEST(MutexDestruction, of_the_driver_is_that_of_the_program) {
  Dl_info found{};
  ASSERT_NE(dladdr(dlsym(RTLD_DEFAULT, "pthread_mutex_destroy"), &found), 0);
  Dl_info program{};
  ASSERT_NE(dladdr(&typeid(GlWrapper), &program), 0);
  EXPECT_STREQ(found.dli_fname, program.dli_fname);
}
#endif

// Checks that objects can be constructed, moved and assigned. A moved-from object must be empty,
// and the GL name must exist until its last owner is destroyed.
template <class T, class IsName>
void expect_moves(T first, T second, IsName is_name) {
  const GLuint name = first.id(), other = second.id();
  ASSERT_NE(name, 0u);
  T moved = std::move(first);
  EXPECT_FALSE(static_cast<bool>(
      first));  // NOLINT(bugprone-use-after-move): the empty state is the contract
  EXPECT_EQ(moved.id(), name);
  second = std::move(moved);
  EXPECT_EQ(second.id(), name);
  EXPECT_FALSE(is_name(other));
  EXPECT_TRUE(is_name(name));
  { T last = std::move(second); }
  EXPECT_FALSE(is_name(name));
}

TEST_F(GlWrapper, a_context_moves_and_is_current) {
  EXPECT_FALSE(context_.platform().empty());
  EglContext moved = std::move(context_);
  EXPECT_FALSE(static_cast<bool>(context_));  // NOLINT(bugprone-use-after-move)
  EXPECT_TRUE(static_cast<bool>(moved));
  EXPECT_FALSE(moved.lost());
  EXPECT_NE(glGetString(GL_VERSION), nullptr);
  context_ = std::move(moved);
}

TEST_F(GlWrapper, a_lost_context_stays_lost_though_the_driver_tells_it_once) {
  GLint strategy = GL_NO_RESET_NOTIFICATION;
  glGetIntegerv(GL_RESET_NOTIFICATION_STRATEGY, &strategy);
  if (strategy != GL_LOSE_CONTEXT_ON_RESET) GTEST_SKIP() << "this driver tells no resets";
  EXPECT_FALSE(context_.lost());
  const auto real = epoxy_glGetGraphicsResetStatus;
  epoxy_glGetGraphicsResetStatus = []() -> GLenum { return GL_UNKNOWN_CONTEXT_RESET; };
  EXPECT_TRUE(context_.lost());
  epoxy_glGetGraphicsResetStatus = real;
  EXPECT_TRUE(context_.lost());
  EglContext moved = std::move(context_);
  EXPECT_TRUE(moved.lost());
  context_ = std::move(moved);
}

TEST_F(GlWrapper, a_gl_error_is_counted) {
  DebugMessages provoked;
  provoked.install();
  glBindTextureUnit(0, 4711);
  EXPECT_EQ(provoked.errors(), 1);
  messages_.install();
  while (glGetError() != GL_NO_ERROR) {
  }
}

TEST_F(GlWrapper, a_buffer_moves) {
  const auto make = [] {
    return std::move(*Buffer::create(256, Buffer::Use::fixed, "test buffer"));
  };
  expect_moves(make(), make(), glIsBuffer);
}

TEST_F(GlWrapper, a_buffer_keeps_what_is_uploaded) {
  auto buffer = Buffer::create(64, Buffer::Use::fixed, "test buffer");
  ASSERT_TRUE(buffer);
  std::array<std::uint32_t, 4> values{1, 2, 3, 4}, read{};
  buffer->upload_values(16, std::span<const std::uint32_t>(values));
  glGetNamedBufferSubData(buffer->id(), 16, sizeof(read), read.data());
  EXPECT_EQ(read, values);
}

TEST_F(GlWrapper, a_texture_moves) {
  const auto make = [] { return std::move(*Texture::create_2d(GL_R8UI, 4, 4, "test texture")); };
  expect_moves(make(), make(), glIsTexture);
}

TEST_F(GlWrapper, a_texture_array_knows_its_size) {
  auto texture = Texture::create_array(GL_RG32UI, 8, 4, 3, "test array");
  ASSERT_TRUE(texture);
  EXPECT_EQ(texture->bytes(), 8u * 4 * 3 * 8);
}

TEST_F(GlWrapper, a_framebuffer_moves_and_is_complete) {
  auto color = Texture::create_2d(GL_R32UI, 4, 4, "color");
  auto depth = Texture::create_2d(GL_DEPTH_COMPONENT32F, 4, 4, "depth");
  const auto make = [&] {
    return std::move(*Framebuffer::create({&*color}, &*depth, "test framebuffer"));
  };
  EXPECT_TRUE(Framebuffer::create({}, &*depth, "depth only"));
  expect_moves(make(), make(), glIsFramebuffer);
  auto small = Texture::create_array(GL_R32UI, 4, 4, 2, "layered");
  const auto refused = Framebuffer::create({&*color, &*small}, nullptr, "layered and not");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::unavailable);
}

TEST_F(GlWrapper, a_vertex_array_moves) {
  auto vertices = Buffer::create(64, Buffer::Use::fixed, "vertices");
  auto indices = Buffer::create(64, Buffer::Use::fixed, "indices");
  const std::array<VertexAttribute, 1> attributes{{{0, 3, GL_FLOAT, false, 0}}};
  const auto make = [&] {
    return VertexArray(*vertices, 16, attributes, *indices, "test vertex array");
  };
  expect_moves(make(), make(), glIsVertexArray);
}

TEST_F(GlWrapper, a_program_moves) {
  const auto make = [] {
    return std::move(*Program::load(test::shader_dir(), {"depth_gather_pass.comp"}));
  };
  expect_moves(make(), make(), glIsProgram);
}

TEST_F(GlWrapper, a_timer_query_moves_and_measures) {
  const auto make = [] { return TimerQuery::create("test query"); };
  const TimerQuery timer = make();
  timer.begin();
  timer.end();
  EXPECT_GE(timer.elapsed_ms(), 0);
  const auto begun = [] {
    TimerQuery query = TimerQuery::create("test query");
    return query;
  };
  TimerQuery first = begun();
  TimerQuery second = std::move(first);
  EXPECT_FALSE(static_cast<bool>(first));  // NOLINT(bugprone-use-after-move)
  EXPECT_TRUE(static_cast<bool>(second));
}

TEST_F(GlWrapper, a_fence_moves_and_passes) {
  Fence fence = Fence::place();
  Fence moved = std::move(fence);
  EXPECT_FALSE(static_cast<bool>(fence));  // NOLINT(bugprone-use-after-move)
  EXPECT_TRUE(fence.passed());
  while (!moved.passed(1'000'000)) {
  }
  EXPECT_FALSE(static_cast<bool>(moved));
}

TEST_F(GlWrapper, a_readback_brings_data_and_its_buffer_is_used_again) {
  ReadbackPool pool;
  auto source = Buffer::create(4096, Buffer::Use::fixed, "source");
  std::vector<std::uint32_t> values(1024);
  std::iota(values.begin(), values.end(), 5u);
  source->upload_values(0, std::span<const std::uint32_t>(values));
  GLuint first_buffer = 0;
  for (int round = 0; round < 2; ++round) {
    auto readback = pool.begin(4096);
    ASSERT_TRUE(readback);
    if (round == 0) first_buffer = readback->buffer().id();
    EXPECT_EQ(readback->buffer().id(), first_buffer);
    glCopyNamedBufferSubData(source->id(), readback->buffer().id(), 0, 0, 4096);
    readback->submit();
    Readback moved = std::move(*readback);
    while (!moved.ready(1'000'000)) {
    }
    ASSERT_EQ(moved.data().size(), 4096u);
    EXPECT_EQ(std::memcmp(moved.data().data(), values.data(), 4096), 0);
  }
}

}  // namespace
}  // namespace strata::gl
