/* glue.cpp - puts the plain C face of vodr_rtl.h on what Verilator made of a module. scripts/rtl-library compiles it
 * beside a "model.h" of its own that names the class, `model_class`, and lists its ports, MODEL_PORTS(PORT). */
#include "vodr_rtl.h"

#include <cstring>
#include <new>
#include <vector>

#include "model.h"
#include "verilated.h"
#ifdef MODEL_COVERAGE
#include <cstdlib>
#include <unistd.h>

#include "verilated_cov.h"
#endif
#ifdef MODEL_TRACE
#include "verilated_fst_c.h"
#endif

namespace
{

/* Registers hold anything before the reset; Verilator takes a seed of 0 for none. */
struct seeded_context : VerilatedContext {
    explicit seeded_context(uint32_t seed)
    {
        randReset(2);
        randSeed(static_cast<int>(seed % 0x7FFFFFFF) + 1);
    }
};

struct model {
    seeded_context context;
    model_class module{&context};
    std::vector<vodr_rtl_port> ports;
#ifdef MODEL_TRACE
    VerilatedFstC waveform;
#endif
    explicit model(uint32_t seed) : context(seed)
    {
    }
    ~model()
    {
        module.final();
    }
};

void eval(void *state)
{
    static_cast<model *>(state)->module.eval();
}

#ifdef MODEL_COVERAGE
/* What the model covered, in a file of its own in the folder that was named when the library was made. */
void write_coverage(model *m)
{
    char path[] = MODEL_COVERAGE "/XXXXXX";
    int file = mkstemp(path);
    if (file < 0)
        return;
    close(file);
    m->context.coveragep()->write(path);
}
#endif

void finish(void *state)
{
    model *m = static_cast<model *>(state);
#ifdef MODEL_COVERAGE
    write_coverage(m);
#endif
    delete m;
}

#ifdef MODEL_TRACE
bool trace(void *state, const char *path)
{
    model *m = static_cast<model *>(state);
    m->module.trace(&m->waveform, 99);
    m->waveform.open(path);
    return m->waveform.isOpen();
}

void dump(void *state, uint64_t time)
{
    static_cast<model *>(state)->waveform.dump(time);
}
#endif

} // namespace

extern "C" bool vodr_rtl_open(vodr_rtl_model *out, uint32_t seed)
try {
    model *m = new model(seed);
#ifdef MODEL_TRACE
    m->context.traceEverOn(true);
#endif
#define PORT(name, high, is_output)                                                                                    \
    m->ports.push_back({#name, (high) + 1, is_output, &m->module.name});                                               \
    if (!(is_output))                                                                                                  \
        std::memset(&m->module.name, 0, sizeof m->module.name);
    MODEL_PORTS(PORT)
#undef PORT
    *out = vodr_rtl_model{};
    out->state = m;
    out->ports = m->ports.data();
    out->port_count = static_cast<int32_t>(m->ports.size());
    out->eval = eval;
    out->finish = finish;
#ifdef MODEL_TRACE
    out->trace = trace;
    out->dump = dump;
#endif
    return true;
} catch (const std::bad_alloc &) {
    return false;
}
