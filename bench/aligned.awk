# aligned.awk - the tables of bench/aligned from its lines of JSON, and from those of a record of a card.
function value(name,    text) {
    if (!match($0, "\"" name "\": (\"[^\"]*\"|[^,}]*)")) return ""
    text = substr($0, RSTART + length(name) + 4, RLENGTH - length(name) - 4)
    gsub(/"/, "", text)
    return text
}
# A figure by the clock and, where the CPU draws, of it.
function both(clock, of_cpu, digits) { return sprintf("%.*f", digits, clock) (on_cpu ? sprintf(" (%.*f)", digits, of_cpu) : "") }
/"result": "aligned_orbit"/ {
    at = value("volume") ", " value("size_vox") " | " value("device")
    if (!(at in seen)) { seen[at] = 1; order[++volumes] = at; about = value("size_px") }
    key = at " " value("way")
    if (!(value("way") in known)) { known[value("way")] = 1; ways[++count] = value("way") }
    cpu[at] = value("device") ~ /^CPU/
    mean_cpu[key] = value("mean_cpu_ms"); worst_cpu[key] = value("worst_cpu_ms"); best_cpu[key] = value("best_cpu_ms")
    mean[key] = value("mean_ms"); worst[key] = value("worst_ms"); best[key] = value("best_ms")
    speed[key] = value("gsamples_s"); frames[at] = value("frames"); times[at] = times[at] ? times[at] : value("times")
    db[key] = value("least_db"); turn[key] = value("turn_ms"); differs[key] = value("differing_px"); copies[key] = value("copies")
}
/"result": "aligned_prefilter"/ {
    filters[++filtered] = sprintf("| %s | %s | %.1f | %.1f | %.1f | %.1f |", value("device"), value("size_vox"), value("ms"), value("least_ms"), value("least_cpu_ms"), value("least_copy_ms"))
}
/"result": "teem"/ {
    teem[++teems] = sprintf("| %s | %.1f | %.0f (%.0f) | %.0f (%.0f) | %.0f (%.0f) | %.1f (%.1f) | %.1f (%.1f) |", value("view"), value("psnr"),
        value("teem_ms"), value("teem_cpu_ms"), value("none_ms"), value("none_cpu_ms"), value("aligned_ms"), value("aligned_cpu_ms"),
        value("teem_ms") / value("none_ms"), value("teem_cpu_ms") / value("none_cpu_ms"),
        value("teem_ms") / value("aligned_ms"), value("teem_cpu_ms") / value("aligned_cpu_ms"))
}
/"result": "aligned_quality"/ {
    if (!exact || value("double_db") + 0 < exact) exact = value("double_db") + 0
}
/"kernel": "eight-fetch"/ {
    if (value("view") != "frame" && (!eight || value("gsamples_s") + 0 > eight)) eight = value("gsamples_s") + 0
}
/"result": "aligned_profile"/ {
    profile[++profiles] = sprintf("| %s, %s | %s | %s | %s | %s | %s |", value("volume"), value("view"), value("way"), value("sectors_per_request"),
        value("l1_hit"), value("l2_hit"), value("dram_mb"))
}
END {
    print "\nMilliseconds a frame, " about "x" about " pixels, a sample a voxel, over the views of an orbit; how many times as fast as `none`; in brackets both threads of the CPU:\n"
    print "| volume | device | way | mean | worst | best | none/way, mean | none/way, worst view | billion samples/s | pixels not of `none` | least dB |"
    print "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
    for (i = 1; i <= volumes; i++)
        for (w = 1; w <= count; w++) {
            key = order[i] " " ways[w]; none = order[i] " none"
            if (!(key in mean) || (cpu[order[i]] && ways[w] == "aligned, one copy")) continue # the CPU has but one
            on_cpu = cpu[order[i]]
            printf "| %s | %s | %s | %s | %s | %s | %s | %.3f | %d | %s |\n", order[i], ways[w], both(mean[key], mean_cpu[key], on_cpu ? 0 : 2),
                both(worst[key], worst_cpu[key], on_cpu ? 0 : 2), both(best[key], best_cpu[key], on_cpu ? 0 : 2),
                both(mean[none] / mean[key], mean_cpu[none] / mean_cpu[key], 2), both(worst[none] / worst[key], worst_cpu[none] / worst_cpu[key], 2),
                speed[key], differs[key], db[key] + 0 == 999 || w == 1 ? "" : db[key]
        }
    print "\nCoefficients of B-splines, and one copy of them, milliseconds by the clock:\n"
    print "| device | voxels | prefilter | least | on the CPU, all threads | copy, least |"
    print "| --- | --- | --- | --- | --- | --- |"
    for (i = 1; i <= filtered; i++) print filters[i]
    if (exact) printf "\nAgainst double precision every way but `aligned-paper` is at least %.1f dB, over the range of the picture.\n", exact
    if (eight) printf "\nEight fetches of a texture unit, weights of 8 bits, in the same run: %.1f billion samples/s at the best view.\n", eight
    if (profiles) {
        print "\nThe profiler's figures of one frame:\n"
        print "| volume, view | way | sectors a request | hits in L1, % | hits in L2, % | MB of the card's memory |"
        print "| --- | --- | --- | --- | --- | --- |"
        for (i = 1; i <= profiles; i++) print profile[i]
    }
    if (!teems) exit
    print "\nBeside teem's mrender, the maximum of bonsai (256^3) through B-splines, 256x256 pixels, a sample a voxel, 2 threads of the CPU, milliseconds by the clock and, in brackets, of both threads:\n"
    print "| view | dB | teem | `none` | `aligned` | teem/none | teem/aligned |"
    print "| --- | --- | --- | --- | --- | --- | --- |"
    for (i = 1; i <= teems; i++) print teem[i]
}
