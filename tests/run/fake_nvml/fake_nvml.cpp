// NVML as a test wants it. FAKE_NVML in the environment says what it answers: "init=9 count=2
// clock=1980,1200 reasons=0,0x40", the n-th call of a function the n-th value, later ones the last.
// A function that is not named fails. Two GPUs: GPU-1... at 0000:01:00.0 and GPU-2... at
// 0000:02:00.0, whose temperature is always 99.
// With FAKE_NVML_OLD defined it is an older library, without some of the functions.

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <sstream>
#include <string>

namespace {

constexpr int kSuccess = 0, kNotSupported = 3, kNotFound = 6;

bool next(const char* what, unsigned long long& value) {
    static std::map<std::string, int> calls;
    const char* environment = std::getenv("FAKE_NVML");
    std::istringstream words(environment == nullptr ? "" : environment);
    for (std::string word; words >> word;) {
        const std::size_t equals = word.find('=');
        if (word.substr(0, equals) != what) continue;
        std::istringstream values(word.substr(equals + 1));
        const int call = calls[word]++;  // another list begins anew
        std::string text;
        for (int i = 0; i <= call && std::getline(values, text, ',');) ++i;
        value = std::strtoull(text.c_str(), nullptr, 0);
        return true;
    }
    return false;
}

template <typename T>
int answer(const char* what, T* value) {
    unsigned long long number = 0;
    if (!next(what, number)) return kNotSupported;
    *value = T(number);
    return kSuccess;
}

}  // namespace

extern "C" {

#define EXPORT __attribute__((visibility("default")))
struct Gpu {
    int number;
};
static Gpu gpus[] = {{1}, {2}};

EXPORT int nvmlInit_v2() {
    unsigned long long error = 0;
    next("init", error);
    return int(error);
}
EXPORT int nvmlShutdown() {
    return kSuccess;
}
EXPORT const char* nvmlErrorString(int error) {
    return error == 9 ? "Driver Not Loaded" : "Unknown Error";
}
EXPORT int nvmlDeviceGetCount_v2(unsigned* count) {
    return answer("count", count);
}
EXPORT int nvmlDeviceGetHandleByIndex_v2(unsigned index, Gpu** gpu) {
    *gpu = &gpus[index];
    return kSuccess;
}
EXPORT int nvmlDeviceGetHandleByPciBusId_v2(const char* pci, Gpu** gpu) {
    int number = 0;
    if (std::sscanf(pci, "0000:%d:00.0", &number) != 1 || number < 1 || number > 2) {
        return kNotFound;
    }
    *gpu = &gpus[number - 1];
    return kSuccess;
}
EXPORT int nvmlDeviceGetHandleByUUID(const char* uuid, Gpu** gpu) {
    for (Gpu& one : gpus) {
        char own[64];
        std::snprintf(own, sizeof own, "GPU-%d1111111-2222-3333-4444-555555555555", one.number);
        *gpu = &one;
        if (std::strcmp(uuid, own) == 0) return kSuccess;
    }
    return kNotFound;
}
EXPORT int nvmlDeviceGetName(Gpu* gpu, char* name, unsigned size) {
    std::snprintf(name, size, "Fake GPU %d", gpu->number);
    return kSuccess;
}
EXPORT int nvmlDeviceGetClockInfo(Gpu*, int, unsigned* mhz) {
    return answer("clock", mhz);
}
EXPORT int nvmlDeviceGetMaxClockInfo(Gpu*, int, unsigned* mhz) {
    return answer("max_clock", mhz);
}
EXPORT int nvmlDeviceGetTemperature(Gpu* gpu, int, unsigned* celsius) {
    if (gpu->number == 2) {
        *celsius = 99;
        return kSuccess;
    }
    return answer("temperature", celsius);
}
EXPORT int nvmlDeviceGetTemperatureThreshold(Gpu*, int, unsigned* celsius) {
    return answer("threshold", celsius);
}
#ifndef FAKE_NVML_OLD
EXPORT int nvmlDeviceGetPowerUsage(Gpu*, unsigned* milliwatts) {
    return answer("power", milliwatts);
}
EXPORT int nvmlDeviceGetCurrentClocksEventReasons(Gpu*, unsigned long long* reasons) {
    return answer("reasons", reasons);
}
EXPORT int nvmlSystemGetDriverVersion(char* version, unsigned size) {
    std::snprintf(version, size, "580.82");
    return kSuccess;
}
#else
EXPORT int nvmlDeviceGetCurrentClocksThrottleReasons(Gpu*, unsigned long long* reasons) {
    return answer("reasons", reasons);
}
#endif
}
