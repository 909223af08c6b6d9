/* cluster_options.c - the options of `vodr cluster` about nodes, and which go together with others. */
#include "cluster_options.h"

#include "text.h"

static const char *const balances[] = {
    [CLUSTER_STATIC] = "static", [CLUSTER_OCTREE] = "octree", [CLUSTER_PAPER] = "paper", [CLUSTER_BEST] = "best", NULL};
static const char *const weights[] = {
    [CLUSTER_COUNT] = "count", [CLUSTER_SAMPLES] = "samples", [CLUSTER_TIME] = "time", NULL};
static const char *const composites[] = {
    [CLUSTER_DIRECT] = "direct", [CLUSTER_BINARY_SWAP] = "binary-swap", [CLUSTER_RADIX_K] = "radix-k", NULL};

static host_status set_balance(void *target, const option *o, const char *value, host_error *error)
{
    int i;
    host_status status = option_word(o, value, balances, "static, octree, paper or best", &i, error);
    if (status == HOST_OK)
        ((cluster_wish *)target)->options.balance = (cluster_balance)i;
    return status;
}

static host_status set_weight(void *target, const option *o, const char *value, host_error *error)
{
    int i;
    host_status status = option_word(o, value, weights, "count, samples or time", &i, error);
    if (status == HOST_OK)
        ((cluster_wish *)target)->options.weight = (cluster_weight)i;
    return status;
}

static host_status set_composite(void *target, const option *o, const char *value, host_error *error)
{
    int i;
    host_status status = option_word(o, value, composites, "direct, binary-swap or radix-k", &i, error);
    if (status == HOST_OK)
        ((cluster_wish *)target)->options.composite = (cluster_composite)i;
    return status;
}

static host_status set_subvolume(void *target, const option *o, const char *value, host_error *error)
{
    int64_t edge_vox;
    if (!text_integer(value, CLUSTER_LEAST_SUBVOLUME_VOX, CLUSTER_MOST_SUBVOLUME_VOX, &edge_vox))
        return option_refuse(o, value, "an integer from 4 to 64", error);
    ((cluster_wish *)target)->options.subvolume_vox = (int32_t)edge_vox;
    return HOST_OK;
}

static host_status set_nodes(void *target, const option *o, const char *value, host_error *error)
{
    int64_t nodes;
    if (!text_integer(value, 1, CLUSTER_MAX_NODES, &nodes))
        return option_refuse(o, value, "an integer from 1 to 1024", error);
    ((cluster_wish *)target)->options.nodes = (int32_t)nodes;
    return HOST_OK;
}

static host_status set_network(void *target, const option *o, const char *value, host_error *error)
{
    double model[2];
    if (!text_numbers(value, ',', 2, 2, model) || model[0] < 0 || model[0] > 1e6 || model[1] < 1e-6 || model[1] > 1e6)
        return option_refuse(o, value,
                             "MICROSECONDS,GBIT: a latency from 0 to 1000000, a rate from 0.000001 to 1000000", error);
    ((cluster_wish *)target)->options.latency_s = model[0] * 1e-6;
    ((cluster_wish *)target)->options.bytes_per_s = model[1] * 1e9 / 8;
    return HOST_OK;
}

static host_status set_channel(void *target, const option *o, const char *value, host_error *error)
{
    static const char *const words[] = {"float", "uint16", NULL};
    int i;
    host_status status = option_word(o, value, words, "float or uint16", &i, error);
    if (status == HOST_OK)
        ((cluster_wish *)target)->options.pixel_bits = i ? 16 : 32;
    return status;
}

static host_status set_memory(void *target, const option *o, const char *value, host_error *error)
{
    double mib;
    if (!text_number(value, 0.001, 1e9, &mib))
        return option_refuse(o, value, "a number of MiB from 0.001 to 1000000000", error);
    ((cluster_wish *)target)->options.memory_bytes = (size_t)(mib * (1 << 20));
    return HOST_OK;
}

static host_status set_renderer(void *target, const option *o, const char *value, host_error *error)
{
    static const char *const words[] = {"reference", "machine", NULL};
    int i;
    host_status status = option_word(o, value, words, "reference or machine", &i, error);
    if (status == HOST_OK)
        ((cluster_wish *)target)->machine = i > 0;
    return status;
}

static host_status set_link(void *target, const option *o, const char *value, host_error *error)
{
    double model[2];
    if (!text_numbers(value, ',', 2, 2, model) || model[0] < 0 || model[0] > 1e9 || model[1] < 1e-3 || model[1] > 1e6)
        return option_refuse(o, value, "CYCLES,BYTES: a latency from 0 to 1e9, bytes a cycle from 0.001 to 1e6", error);
    ((cluster_wish *)target)->options.latency_cycles = model[0];
    ((cluster_wish *)target)->options.bytes_per_cycle = model[1];
    return HOST_OK;
}

static host_status set_then(void *target, const option *o, const char *value, host_error *error)
{
    cluster_wish *w = target;
    if (w->changes == CLUSTER_CHANGES)
        return host_fail(error, HOST_BAD_INPUT, "--%s '%.512s': may be given %d times", o->name, value,
                         CLUSTER_CHANGES);
    w->then[w->changes++] = value;
    return HOST_OK;
}

static const option rows[] = {
    {"balance", 0, "METHOD", false, set_balance,
     "static, octree, paper, best (best)\n"
     "how sub-volumes are dealt out to nodes"},
    {"weight", 0, "WEIGHT", false, set_weight,
     "count, samples, time (count)\n"
     "what a sub-volume counts: 1, the samples that rays take\n"
     "in it, or its time in the frame before (--repeat)"},
    {"subvolume", 0, "N", false, set_subvolume, "edge of a sub-volume in voxels, 4 to 64 (8)"},
    {"composite", 0, "METHOD", false, set_composite, "direct, binary-swap, radix-k (radix-k)"},
    {"channel", 0, "TYPE", false, set_channel,
     "float or uint16: colours between nodes; maxima are always\n"
     "floats (float)"},
    {"then", 0, "NAME|FILE", true, set_then,
     "change to this transfer function afterwards, as --tf: nodes\n"
     "exchange what changes owner; output is of the last"},
    {"node-memory", 0, "MIB", false, set_memory, "voxels that a node may hold (no limit)"},
    {"nodes", 0, "N", false, set_nodes, "simulate 1 to 1024 nodes in one process, one after another"},
    {"renderer", 0, "NAME", false, set_renderer,
     "reference, machine (reference)\n"
     "what draws: with machine each node is one, of --machine and\n"
     "--set, and costs cycles"},
    {"link", 0, "CYCLES,BYTES", false, set_link,
     "of machines: latency of a message, bytes a cycle of each\n"
     "(200,16)"},
    {"network", 0, "MICROS,GBIT", false, set_network,
     "of simulated nodes: latency of a message, rate of each\n"
     "(20,10)"},
};
const option_table option_cluster = {"Nodes:", rows, sizeof rows / sizeof *rows};

cluster_wish cluster_wish_default(void)
{
    return (cluster_wish){.options = {.balance = CLUSTER_BEST,
                                      .composite = CLUSTER_RADIX_K,
                                      .subvolume_vox = 8,
                                      .pixel_bits = 32,
                                      .latency_cycles = 200,
                                      .bytes_per_cycle = 16,
                                      .latency_s = 20e-6,
                                      .bytes_per_s = 10e9 / 8}};
}

/* Nodes that are machines. */
static host_status check_machine(const cluster_wish *nodes, const reference_wish *wish, const vodr_machine *machine,
                                 host_error *error)
{
    const char *with = machine->blend == VODR_BLEND_MIP           ? "blend mip"
                       : wish->choice.method == REFERENCE_RAYCAST ? "--method raycast"
                       : wish->choice.shading == REFERENCE_PHONG  ? "--shading phong"
                       : wish->choice.numbers != REFERENCE_FLOAT  ? "--numbers"
                       : nodes->changes > 0                       ? "--then"
                       : nodes->options.weight == CLUSTER_TIME    ? "--weight time"
                                                                  : NULL;
    return with ? host_fail(error, HOST_BAD_INPUT, "--renderer machine does not go with %s", with) : HOST_OK;
}

host_status cluster_options_check(const cluster_wish *nodes, const reference_wish *wish, const view_options *v,
                                  host_error *error)
{
    const reference_accel accel = wish->choice.accel;
    vodr_machine machine;
    if (wish->choice.fixed)
        return host_fail(error, HOST_BAD_INPUT,
                         "--numbers fixed draws whole volumes: cluster has float, double and texture");
    if (reference_is_cubic(wish->choice.filter))
        return host_fail(error, HOST_BAD_INPUT,
                         "--filter cardinal and bspline draw whole volumes: cluster has nearest and linear");
    host_status status = view_options_machine(v, &machine, error);
    if (status == HOST_OK && machine.blend == VODR_BLEND_MIP && accel != REFERENCE_ACCEL_NONE &&
        accel != REFERENCE_ACCEL_BEST)
        return host_fail(error, HOST_BAD_INPUT, "--accel %s: of parts of a volume, mip has none and best",
                         reference_accel_name(&wish->choice));
    return status == HOST_OK && nodes->machine ? check_machine(nodes, wish, &machine, error) : status;
}

const char *cluster_balance_name(cluster_balance balance)
{
    return balances[balance];
}

const char *cluster_weight_name(cluster_weight weight)
{
    return weights[weight];
}

const char *cluster_composite_name(cluster_composite composite)
{
    return composites[composite];
}
