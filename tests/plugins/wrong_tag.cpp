#include "quiet_method.h"

extern "C"
    __attribute__((visibility("default"))) constexpr lodbench::PluginDescriptor lodbench_plugin = {
        lodbench::kAbi, sizeof(lodbench::PluginDescriptor), "another compiler", nullptr, 0, 0,
        nullptr};
