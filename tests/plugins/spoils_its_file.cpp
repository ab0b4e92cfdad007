// While it is loaded, it does to its own file what LODBENCH_TEST_SPOILS says: "remove", "exchange"
// for one that is no plugin, or "append" a byte.

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "quiet_method.h"

namespace {

__attribute__((constructor)) void spoil() {
    const char* asked = std::getenv("LODBENCH_TEST_SPOILS");
    Dl_info self{};
    if (asked == nullptr || dladdr(reinterpret_cast<void*>(&spoil), &self) == 0) return;
    const std::string what = asked;
    const std::string file = self.dli_fname;
    if (what == "remove") std::remove(file.c_str());
    if (what == "append") std::ofstream(file, std::ios::app | std::ios::binary) << ' ';
    if (what == "exchange") {
        std::ofstream(file + ".new") << "no plugin\n";
        std::rename((file + ".new").c_str(), file.c_str());
    }
}

}  // namespace

QUIET_PLUGIN(QuietMethod, "spoils-its-file");
