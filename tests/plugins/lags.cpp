// Not broken but slow: a thread of its own prepares each frame's surface, which takes `work_ms`,
// and what is drawn is the latest that is ready. The surface for the eye E, drawn for the eye F, is
// the terrain raised by a tenth of |E - F|: settled it is exact, and by the error one sees how far
// behind it is.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <glm/geometric.hpp>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "gl/embedded_shaders.h"
#include "gl/objects.h"
#include "gl/program.h"
#include "quiet_method.h"

namespace {

using SteadyClock = std::chrono::steady_clock;

/// Prepares the surface for an eye; of several that wait for it only the latest.
class Worker {
public:
    explicit Worker(SteadyClock::duration work) : work_(work), thread_([this] { run(); }) {}
    ~Worker() {
        {
            const std::lock_guard lock(mutex_);
            stopping_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// Waits only where there is nothing yet that could be drawn meanwhile.
    void ask_for(const glm::dvec3& eye) {
        std::unique_lock lock(mutex_);
        wanted_ = {wanted_.number + 1, eye};
        changed_.notify_all();
        if (ready_.number == 0) wait_for_ready(lock);
    }
    void settle() {
        std::unique_lock lock(mutex_);
        if (paused_) throw std::logic_error("settle while paused would wait for ever");
        wait_for_ready(lock);
    }
    /// The work stands still meanwhile, and what is ready stays as it is.
    void pause(bool paused) {
        const std::lock_guard lock(mutex_);
        if (paused == paused_) throw std::logic_error("pause and resume take turns");
        paused_ = paused;
        changed_.notify_all();
    }
    [[nodiscard]] glm::dvec3 ready_eye() {
        const std::lock_guard lock(mutex_);
        return ready_.eye;
    }
    [[nodiscard]] bool paused() {
        const std::lock_guard lock(mutex_);
        return paused_;
    }

private:
    struct Surface {
        std::uint64_t number = 0;  ///< 0: none
        glm::dvec3 eye{0.0};
    };

    void wait_for_ready(std::unique_lock<std::mutex>& lock) {
        changed_.wait(lock, [this] { return ready_.number == wanted_.number; });
    }

    void run() {
        std::unique_lock lock(mutex_);
        for (;;) {
            changed_.wait(lock, [this] { return stopping_ || ready_.number != wanted_.number; });
            const Surface surface = wanted_;
            for (auto left = work_; left.count() > 0 && !stopping_;) {
                changed_.wait(lock, [this] { return stopping_ || !paused_; });
                const auto start = SteadyClock::now();
                changed_.wait_for(lock, left, [this] { return stopping_ || paused_; });
                left -= SteadyClock::now() - start;
            }
            changed_.wait(lock, [this] { return stopping_ || !paused_; });
            if (stopping_) return;
            ready_ = surface;
            changed_.notify_all();
        }
    }

    SteadyClock::duration work_;
    std::mutex mutex_;
    std::condition_variable changed_;
    Surface wanted_, ready_;
    bool paused_ = false;
    bool stopping_ = false;
    std::thread thread_;  // last: it uses the others
};

class Lags final : public QuietMethod {
public:
    explicit Lags(const lodbench::Params& params)
        : QuietMethod(params),
          worker_(std::chrono::duration_cast<SteadyClock::duration>(
              std::chrono::duration<double, std::milli>(params.real("work_ms")))) {}

    void prepare(const lodbench::Terrain& terrain, lodbench::gl::Device&) override {
        rows_ = terrain.info().rows;
        columns_ = terrain.info().columns;
        heights_.resize(std::size_t(rows_) * std::size_t(columns_));
        terrain.read({0, 0, rows_, columns_}, heights_);
    }
    void upload(lodbench::gl::Device& device) override {
        device_ = &device;
        program_ = lodbench::gl::Program(
            device, "lags", lodbench::embedded_shaders(),
            {{GL_VERTEX_SHADER, "lags.vert"}, {GL_FRAGMENT_SHADER, "common/terrain.frag"}});
        height_buffer_ =
            lodbench::gl::Buffer(device, "lags: heights", std::span<const float>(heights_));
        std::vector<std::uint32_t> indices;
        for (int row = 0; row + 1 < rows_; ++row) {
            for (int column = 0; column + 1 < columns_; ++column) {
                const auto nw = std::uint32_t(row * columns_ + column), ne = nw + 1;
                const auto sw = nw + std::uint32_t(columns_), se = sw + 1;
                indices.insert(indices.end(), {nw, sw, se, nw, se, ne});
            }
        }
        index_count_ = GLsizei(indices.size());
        index_buffer_ =
            lodbench::gl::Buffer(device, "lags: indices", std::span<const std::uint32_t>(indices));
        vertices_ = lodbench::gl::VertexArray(device, "lags: vertices");
        vertices_.attribute(0, 1, height_buffer_, 0, sizeof(float));
        vertices_.elements(index_buffer_);
    }
    void select(const lodbench::Camera& camera, const lodbench::Clock&) override {
        selected_eye_ = camera.position;
        worker_.ask_for(camera.position);
    }
    void settle() override { worker_.settle(); }
    void pause_background() override { worker_.pause(true); }
    void resume_background() override { worker_.pause(false); }
    void draw(const lodbench::View&) override {
        if (device_->capturing() && !worker_.paused()) {
            throw std::logic_error("captured while the background works");
        }
        program_.set("grid_columns", columns_);
        program_.set("raised", float(0.1 * glm::distance(worker_.ready_eye(), selected_eye_)));
        device_->draw_elements(program_, vertices_, GL_TRIANGLES, index_count_, GL_UNSIGNED_INT);
    }
    void release(lodbench::gl::Device&) override {
        vertices_ = {};
        index_buffer_ = {};
        height_buffer_ = {};
        program_ = {};
    }

private:
    Worker worker_;
    glm::dvec3 selected_eye_{0.0};
    int rows_ = 0, columns_ = 0;
    std::vector<float> heights_;
    lodbench::gl::Device* device_ = nullptr;
    lodbench::gl::Program program_;
    lodbench::gl::Buffer height_buffer_, index_buffer_;
    lodbench::gl::VertexArray vertices_;
    GLsizei index_count_ = 0;
};

constexpr lodbench::ParamSpec kParams[] = {
    lodbench::real_param("work_ms", 30, 0, 60000, "time that a surface takes, ms")};

constexpr lodbench::MethodDescriptor kMethods[] = {[] {
    lodbench::MethodDescriptor descriptor = quiet_descriptor<Lags>("lags");
    descriptor.title = "Draws what a thread has prepared for an earlier frame";
    descriptor.capabilities = lodbench::kAsynchronous;
    descriptor.params = kParams;
    descriptor.param_count = std::size(kParams);
    return descriptor;
}()};

}  // namespace

LODBENCH_PLUGIN(kMethods);
