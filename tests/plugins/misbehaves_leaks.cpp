// Methods that give nothing back, one kind of resource each.

#include <GL/glcorearb.h>
#include <fcntl.h>
#include <semaphore.h>
#include <signal.h>
#include <sys/ipc.h>
#include <sys/mman.h>
#include <sys/shm.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "misbehaving.h"

namespace {

constexpr std::size_t kBytes = 1 << 20;

/// What a compiler must not find unused.
void keep(void* pointer) {
    static std::vector<void*>& kept = *new std::vector<void*>;
    kept.push_back(pointer);
}

constexpr Misbehaviour kLeaks[] = {
    {"leaks-memory", When::draw, [] { keep(std::memset(new char[kBytes], 1, kBytes)); }},
    {"leaks-mappings", When::draw,
     [] {
         keep(mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
     }},
    {"leaks-textures", When::draw,
     [] {
         GLuint texture = 0;
         glCreateTextures(GL_TEXTURE_2D, 1, &texture);
         glTextureStorage2D(texture, 1, GL_RGBA8, 64, 64);
     }},
    {"leaks-buffers", When::draw,
     [] {
         GLuint buffer = 0;
         glCreateBuffers(1, &buffer);
         glNamedBufferStorage(buffer, kBytes, nullptr, 0);
     }},
    {"leaks-vertex-arrays", When::draw,
     [] {
         GLuint arrays[16];
         glCreateVertexArrays(16, arrays);
     }},
    {"leaks-threads", When::draw,
     [] { std::thread([] { std::this_thread::sleep_for(std::chrono::hours(1)); }).detach(); }},
    {"leaks-a-descriptor-a-frame", When::select,
     [] { static_cast<void>(open("/dev/null", O_RDONLY)); }},
    {"leaks-temporary-files", When::select, [] { keep(std::tmpfile()); }},
    {"leaks-shared-memory", When::select,
     [] {
         const int segment = shmget(IPC_PRIVATE, kBytes, 0600);
         keep(shmat(segment, nullptr, 0));
         shmctl(segment, IPC_RMID, nullptr);  // gone with its last user: this process
     }},
    {"leaks-semaphores", When::select,
     [] {
         const std::string name = "/lodbench-test-" + std::to_string(getpid());
         keep(sem_open(name.c_str(), O_CREAT, 0600, 1));
         sem_unlink(name.c_str());
     }},
    {"leaks-timer-descriptors", When::select,
     [] { static_cast<void>(timerfd_create(CLOCK_MONOTONIC, 0)); }},
    {"leaves-an-alarm", When::select,
     [] {
         const itimerval soon{{0, 0}, {0, 10'000}};
         setitimer(ITIMER_REAL, &soon, nullptr);
     }},
    {"leaks-children", When::select,
     [] {
         if (fork() == 0) {
             for (;;) pause();
         }
     }},
};

}  // namespace

MISBEHAVING_PLUGIN(kLeaks);
