#pragma once
// A window with an OpenGL context and Dear ImGui in it.

#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "api/camera.h"

struct GLFWwindow;

namespace lodbench::view {

/// How GLFW makes the context.
enum class ContextApi { any, egl, glx };

struct WindowOptions {
    Viewport size;  ///< of the window, in the units of its system
    ContextApi api = ContextApi::any;
    double scale = 0;  ///< of text and margins; 0: the display's own
};

/// What the person does. Keys and text that go into a field of ImGui's do not come here.
struct WindowEvents {
    std::function<void(int key, bool control, bool pressed)> key;
    std::function<void(int button, bool pressed, const glm::dvec2& at)> button;
    std::function<void(const glm::dvec2& at)> moved;  ///< fractions of the window
    std::function<void(double notches)> wheel;
};

/// One at a time. On the thread that made it.
class Window {
public:
    /// Throws EnvironmentError with the system's words, what was tried and what does without a
    /// window, where there is no display or no context.
    explicit Window(const WindowOptions& options, WindowEvents events);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Waits for events for so many seconds, endlessly where that is negative, and handles them.
    void wait(double seconds);
    /// From any thread: ends a wait.
    static void wake();
    [[nodiscard]] bool closed() const;
    void close();
    /// In pixels.
    [[nodiscard]] Viewport pixels() const;
    [[nodiscard]] double scale() const { return scale_; }
    void begin_frame();
    /// Draws what ImGui has and shows it. `before_shown` is called in between.
    void end_frame(const std::function<void()>& before_shown);
    void copy(const std::string& text);
    [[nodiscard]] std::string pasted() const;
    [[nodiscard]] double seconds() const;
    /// Something came since it was last asked.
    [[nodiscard]] bool take_touched();

private:
    static Window& of(GLFWwindow* window);
    void listen();
    [[nodiscard]] glm::dvec2 cursor();
    [[nodiscard]] glm::dvec2 in_window(double x, double y) const;  ///< as fractions

    GLFWwindow* window_ = nullptr;
    WindowEvents events_;
    double scale_ = 1;
    std::optional<glm::dvec2> heard_at_;  ///< where the pointer was when it moved last
    bool touched_ = true;
};

}  // namespace lodbench::view
