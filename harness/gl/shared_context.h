#pragma once
// Further contexts for a method's own threads.

namespace lodbench::gl {

/// A context that shares buffers, textures, programs, samplers and fences with the host's; vertex
/// arrays, framebuffers, queries and feedback are each context's own. Made by
/// `Device::make_shared_context` on the host's thread, used on one other thread: there it is made
/// current, a `Device` of its own is created over it, and both end before it is destroyed.
///
/// What one context writes another sees once a fence behind the writing has been waited for (or
/// the writing was finished) and the object is bound anew.
class SharedContext {
public:
    virtual ~SharedContext() = default;
    SharedContext(const SharedContext&) = delete;
    SharedContext& operator=(const SharedContext&) = delete;

    /// Makes it current on the calling thread, which has no current context. Throws
    /// UnsupportedError where the driver refuses.
    virtual void make_current() = 0;
    /// The reverse, on the same thread.
    virtual void release_current() noexcept = 0;

protected:
    SharedContext() = default;
};

}  // namespace lodbench::gl
