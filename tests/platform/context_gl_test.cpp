// Contexts: what is chosen, what is refused and in which words.
#include <gtest/gtest.h>

#include "api/error.h"
#include "support/context_for_test.h"

namespace lodbench::platform {
namespace {

TEST(Context, is_a_debug_core_context_of_at_least_4_5) {
    const test::GlTest gl;
    EXPECT_FALSE(gl.context.description().empty());
    EXPECT_NE(gl.context.description().find(gl.device.info().renderer), std::string::npos);
    GLint flags = 0;
    GLint profile = 0;
    glGetIntegerv(GL_CONTEXT_FLAGS, &flags);
    glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    EXPECT_TRUE((flags & GL_CONTEXT_FLAG_DEBUG_BIT) != 0);
    EXPECT_TRUE((profile & GL_CONTEXT_CORE_PROFILE_BIT) != 0);
    EXPECT_TRUE(gl.device.has_extension("GL_KHR_debug"));
    EXPECT_FALSE(gl.device.has_extension("GL_KHR"));
}

TEST(Context, software_is_recognised_by_renderer) {
    const test::GlTest gl;
    const bool mesa_software = gl.device.info().renderer.find("llvmpipe") != std::string::npos;
    if (mesa_software) {
        EXPECT_TRUE(gl.device.info().software);
    }
}

TEST(Context, tells_software_from_a_gpu_and_names_the_gpu_as_files_and_uuids_are) {
    const test::GlTest gl;
    const GpuIdentity& gpu = gl.context.gpu();
    EXPECT_EQ(gpu.software, gl.device.info().software);
    EXPECT_EQ(gpu.vendor, gl.device.info().vendor);
    if (gpu.software) {
        EXPECT_EQ(gpu.node + gpu.uuid, "") << "no sensors are those of a rasteriser";
        return;
    }
    EXPECT_EQ(gpu.node.find('/'), std::string::npos);
    EXPECT_TRUE(gpu.uuid.empty() || gpu.uuid.size() == 36) << gpu.uuid;
}

TEST(Context, every_listed_device_opens_by_its_number_or_says_why_not) {
    const std::vector<DeviceEntry> devices = list_devices();
    ASSERT_FALSE(devices.empty());
    for (std::size_t i = 0; i < devices.size(); ++i) {
        EXPECT_EQ(devices[i].number, static_cast<int>(i));
        if (devices[i].name.find("cannot be used: ") != std::string::npos) {
            EXPECT_THROW(Context(std::to_string(i)), EnvironmentError);
        } else {
            EXPECT_EQ(Context(std::to_string(i)).description(), devices[i].name);
        }
    }
}

TEST(Context, part_of_a_name_in_any_case_chooses) {
    std::string name;
    {
        const test::GlTest gl;
        name = gl.device.info().renderer.substr(0, 6);
    }
    for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const Context context(name);
    EXPECT_NE(glGetString(GL_VERSION), nullptr);
}

TEST(Context, refusal_says_what_was_tried) {
    for (const char* device : {"no such card", "4711", "-1"}) {
        try {
            const Context context(device);
            FAIL() << device;
        } catch (const EnvironmentError& error) {
            const std::string text = error.what();
            EXPECT_NE(text.find("for device '" + std::string(device) + "'"), std::string::npos)
                << text;
            EXPECT_TRUE(text.find("does not contain") != std::string::npos ||
                        text.find("there is no device") != std::string::npos)
                << text;
            EXPECT_EQ(text.find('\n'), std::string::npos);
        }
    }
    EXPECT_EQ(glGetString(GL_VERSION), nullptr) << "no context stays current";
}

TEST(Context, listing_devices_keeps_the_current_context) {
    const test::GlTest gl;
    GLuint name = 0;
    glCreateBuffers(1, &name);
    (void)list_devices();
    EXPECT_TRUE(glIsBuffer(name));
    glDeleteBuffers(1, &name);
}

TEST(Context, a_second_one_on_a_thread_is_refused_and_the_first_stays_current) {
    const test::GlTest gl;
    EXPECT_THROW(Context(), ContractError);
    EXPECT_NE(glGetString(GL_VERSION), nullptr);
}

TEST(Context, device_without_a_context_is_refused) {
    EXPECT_THROW(gl::Device(), EnvironmentError);
}

}  // namespace
}  // namespace lodbench::platform
