#include "quiet_method.h"

extern "C"
    __attribute__((visibility("default"))) constexpr lodbench::PluginDescriptor lodbench_plugin = {
        lodbench::kAbi + 98,
        sizeof(lodbench::PluginDescriptor),
        lodbench::kAbiTag,
        nullptr,
        0,
        0,
        nullptr};
