// A thousand lives of the method in one process, ended at random moments.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "gl/host/alive_objects.h"
#include "support/method_fixture.h"

namespace lodbench::test {
namespace {

std::size_t thread_count() {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return std::size_t(std::distance(begin(tasks), end(tasks)));
}

std::size_t resident_bytes() {
    std::ifstream file("/proc/self/statm");
    std::size_t size = 0, resident = 0;
    file >> size >> resident;
    return resident * std::size_t(sysconf(_SC_PAGESIZE));
}

class CountedContext final : public gl::SharedContext {
public:
    CountedContext(std::unique_ptr<gl::SharedContext> inner, int& alive)
        : inner_(std::move(inner)), alive_(alive) {
        ++alive_;
    }
    ~CountedContext() override { --alive_; }
    void make_current() override { inner_->make_current(); }
    void release_current() noexcept override { inner_->release_current(); }

private:
    std::unique_ptr<gl::SharedContext> inner_;
    int& alive_;
};

/// Cannot be made current: the upload ends half-way.
class Refusing final : public gl::SharedContext {
public:
    void make_current() override { throw EnvironmentError("refused"); }
    void release_current() noexcept override {}
};

TEST(MultiContextCycles, a_thousand_leave_no_thread_context_object_or_byte) {
    constexpr int kCycles = 1000;
    constexpr int kWarmUp = 100;
    const std::string plugin = std::string(LODBENCH_PLUGINS) + "/multi_context.so";
    platform::Context context;
    gl::Device device;
    const auto terrain = hills(129, 129);
    const run::PluginLibrary library(plugin);
    const run::MethodInfo info =
        run::find_method({{plugin, library.methods(), "", {}}}, "multi-context", plugin);
    int contexts = 0;
    const auto give_contexts = [&] {
        device.set_context_factory(
            [&] { return std::make_unique<CountedContext>(context.make_shared(), contexts); });
    };
    std::mt19937 random(1);
    std::size_t threads = 0, resident = 0;
    gl::AliveObjects alive;
    for (int cycle = 0; cycle < kCycles; ++cycle) {
        if (cycle == kWarmUp) {
            threads = thread_count();
            resident = resident_bytes();
            alive = gl::count_alive_objects();
        }
        give_contexts();
        const run::Settings settings = {{"async", random() % 4 == 0 ? "false" : "true"},
                                        {"readback", random() % 2 == 0 ? "whole" : "blocks"},
                                        {"spread", random() % 3 == 0 ? "8" : "1"},
                                        {"batch", random() % 2 == 0 ? "true" : "false"},
                                        {"errors", random() % 3 == 0 ? "byte" : "float"},
                                        {"k", random() % 2 == 0 ? "17" : "33"}};
        const Params params = run::make_params(info, settings, "cycle");
        const auto method = library.create("multi-context", params);
        method->prepare(*terrain, device);
        if (cycle % 10 == 9) {
            device.set_context_factory([] { return std::make_unique<Refusing>(); });
            EXPECT_THROW(method->upload(device), EnvironmentError);
        } else {
            method->upload(device);
            const int calls = int(random() % 8);
            for (int call = 0; call < calls; ++call) {
                method->select(camera_at({512300.0 + 10 * call, -3000, 400}, 7.0 * call, -20), {});
                if (random() % 3 == 0) method->settle();
                if (random() % 3 == 0) {
                    method->pause_background();
                    if (call + 1 == calls && random() % 2 == 0) break;  // ends while paused
                    method->resume_background();
                }
            }
        }
        method->release(device);
        ASSERT_EQ(contexts, 0) << "cycle " << cycle;
        ASSERT_EQ(device.objects(), gl::ObjectCounts{}) << "cycle " << cycle;
        ASSERT_EQ(device.allocated_bytes(), 0U) << "cycle " << cycle;
    }
    EXPECT_TRUE(device.take_errors().empty());
    EXPECT_EQ(thread_count(), threads);
    EXPECT_TRUE(gl::differences(alive, gl::count_alive_objects()).empty());
    // What 900 lives may leave in all: the allocator's slack and the driver's caches. A leaked
    // context (1 MB), stack of a thread (8 MB mapped, some kB resident), texture of this terrain
    // (66 kB) or read-back (66 kB) a cycle would each be 60 MB or more.
    EXPECT_LT(resident_bytes(), resident + (std::size_t(24) << 20));
}

}  // namespace
}  // namespace lodbench::test
