#include "view/window.h"

// The order matters: GLFW takes the prototypes that are there already.
#include <GL/glcorearb.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "api/error.h"

namespace lodbench::view {
namespace {

constexpr double kFontPx = 14;

/// What GLFW said last.
std::string glfw_words() {
    const char* words = nullptr;
    return glfwGetError(&words) == GLFW_NO_ERROR || words == nullptr ? "no reason given" : words;
}

[[noreturn]] void refuse(const std::string& what) {
    throw EnvironmentError(fmt::format(
        "no window: {}; `lodbench run` flies without a display, and `lodbench frames` writes "
        "pictures",
        what));
}

GLFWwindow* make_window(const Viewport& size, ContextApi api) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_CONTEXT_CREATION_API,
                   api == ContextApi::egl ? GLFW_EGL_CONTEXT_API : GLFW_NATIVE_CONTEXT_API);
    return glfwCreateWindow(size.width, size.height, "lodbench view", nullptr, nullptr);
}

}  // namespace

Window::Window(const WindowOptions& options, WindowEvents events) : events_(std::move(events)) {
    if (glfwInit() != GLFW_TRUE) refuse(glfw_words());
    std::string tried;
    for (const ContextApi api : {ContextApi::glx, ContextApi::egl}) {
        if (window_ != nullptr || (options.api != ContextApi::any && options.api != api)) continue;
        window_ = make_window(options.size, api);
        if (window_ != nullptr) continue;
        tried +=
            fmt::format("{}an OpenGL 4.5 context through {}: {}", tried.empty() ? "" : "; ",
                        api == ContextApi::egl ? "EGL" : "the display's own way", glfw_words());
    }
    if (window_ == nullptr) {
        glfwTerminate();
        refuse(tried);
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    scale_ = options.scale > 0 ? options.scale : double(x);
    listen();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImFontConfig font;
    font.SizePixels = float(kFontPx * scale_);
    ImGui::GetIO().Fonts->AddFontDefault(&font);
    ImGui::GetStyle().ScaleAllSizes(float(scale_));
    ImGui_ImplGlfw_InitForOpenGL(window_, true);  // calls the listeners that are there
    ImGui_ImplOpenGL3_Init("#version 450 core");
}

Window::~Window() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

Window& Window::of(GLFWwindow* window) {
    Window& self = *static_cast<Window*>(glfwGetWindowUserPointer(window));
    self.touched_ = true;
    return self;
}

/// Of an event, not of now: a pointer may have moved on before a press is heard.
glm::dvec2 Window::cursor() {
    if (heard_at_) return *heard_at_;
    double x = 0, y = 0;
    glfwGetCursorPos(window_, &x, &y);
    return in_window(x, y);
}

glm::dvec2 Window::in_window(double x, double y) const {
    int width = 1, height = 1;
    glfwGetWindowSize(window_, &width, &height);
    return {x / std::max(width, 1), y / std::max(height, 1)};
}

void Window::listen() {
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int mods) {
        Window& self = of(w);
        // A key that is let go is always heard: else one flies on.
        if (action == GLFW_PRESS && ImGui::GetIO().WantTextInput) return;
        if (action != GLFW_REPEAT) {
            self.events_.key(key, (mods & GLFW_MOD_CONTROL) != 0, action == GLFW_PRESS);
        }
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
        Window& self = of(w);
        if (action == GLFW_PRESS && ImGui::GetIO().WantCaptureMouse) return;
        self.events_.button(button, action == GLFW_PRESS, self.cursor());
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
        Window& self = of(w);
        self.heard_at_ = self.in_window(x, y);
        self.events_.moved(*self.heard_at_);
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double notches) {
        Window& self = of(w);
        if (!ImGui::GetIO().WantCaptureMouse) self.events_.wheel(notches);
    });
    glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned) { of(w); });
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { of(w); });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { of(w); });
    glfwSetWindowCloseCallback(window_, [](GLFWwindow* w) { of(w); });
}

void Window::wait(double seconds) {
    if (seconds < 0) {
        glfwWaitEvents();
    } else if (seconds > 0) {
        glfwWaitEventsTimeout(seconds);
    } else {
        glfwPollEvents();
    }
}

void Window::wake() {
    glfwPostEmptyEvent();
}

bool Window::closed() const {
    return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

void Window::close() {
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

Viewport Window::pixels() const {
    Viewport size;
    glfwGetFramebufferSize(window_, &size.width, &size.height);
    return size;
}

void Window::begin_frame() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Window::end_frame(const std::function<void()>& before_shown) {
    ImGui::Render();
    const Viewport size = pixels();
    glViewport(0, 0, size.width, size.height);
    glClearColor(0.1F, 0.1F, 0.1F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    before_shown();
    glfwSwapBuffers(window_);
}

void Window::copy(const std::string& text) {
    glfwSetClipboardString(window_, text.c_str());
}

std::string Window::pasted() const {
    const char* const text = glfwGetClipboardString(window_);
    return text == nullptr ? "" : text;
}

double Window::seconds() const {
    return glfwGetTime();
}

bool Window::take_touched() {
    return std::exchange(touched_, false);
}

}  // namespace lodbench::view
