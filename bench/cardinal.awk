# cardinal.awk - the tables of bench/cardinal from its lines of JSON.
function value(name,    text) {
    if (!match($0, "\"" name "\": (\"[^\"]*\"|[^,}]*)")) return ""
    text = substr($0, RSTART + length(name) + 4, RLENGTH - length(name) - 4)
    gsub(/"/, "", text)
    return text
}
function time(key) { return sprintf("%.0f (%.0f)", ms[key] / views, cpu[key] / views) }
function ratio(a, b) { return sprintf("%.2f (%.2f)", ms[a] / ms[b], cpu[a] / cpu[b]) }
/"result": "cubic"/ {
    volume = value("volume")
    if (!(volume in size)) { order[++volumes] = volume; size[volume] = value("size_vox") }
    key = volume " " value("filter") " " value("accel")
    ms[key] += value("ms"); cpu[key] += value("least_cpu_ms"); samples[key] += value("samples")
    if (value("least_prepare_ms") > change[key]) change[key] = value("least_prepare_ms")
    differs[key] += value("differing_px")
    if (value("farthest") > far[key]) far[key] = value("farthest")
}
/"result": "cubic_preprocess"/ {
    if (!((s = value("size_vox")) in sized)) { sized[s] = 1; sizes[++count] = s }
    pre[s " " value("filter") " " value("accel")] = sprintf("%.0f (%.0f)", value("ms"), value("least_cpu_ms"))
}
/"result": "teem"/ {
    teem[++teems] = sprintf("| %s, %s | %.1f | %.0f (%.0f) | %.0f (%.0f) | %.0f (%.0f) | %.1f (%.1f) | %.1f (%.1f) |", value("filter"), value("view"),
        value("psnr"), value("teem_ms"), value("teem_cpu_ms"), value("none_ms"), value("none_cpu_ms"), value("best_ms"), value("best_cpu_ms"),
        value("teem_ms") / value("none_ms"), value("teem_cpu_ms") / value("none_cpu_ms"), value("teem_ms") / value("best_ms"), value("teem_cpu_ms") / value("best_cpu_ms"))
}
END {
    views = 5
    for (f = 1; f <= 2; f++) {
        filter = f == 1 ? "cardinal" : "bspline"
        print "\n`--filter " filter "`, milliseconds a frame:\n"
        print "| volume | `none` | `rival` | `hull` | `best` | linear, `best` | none/best | rival/best | hull/best | cubic/linear | samples, `best` of `none` |"
        print "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
        for (i = 1; i <= volumes; i++) {
            v = order[i] " " filter " "; l = order[i] " linear best"
            printf "| %s, %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %.2f %% |\n", order[i], size[order[i]], time(v "none"), time(v "rival"), time(v "hull"),
                time(v "best"), time(l), ratio(v "none", v "best"), ratio(v "rival", v "best"), ratio(v "hull", v "best"), ratio(v "best", l),
                100 * samples[v "best"] / samples[v "none"]
        }
    }
    print "\nWhat is derived of the volume alone, milliseconds; in brackets both threads on the CPU, with a picture of 64x64 pixels:\n"
    print "| volume | cardinal, `rival` | cardinal, `hull` | cardinal, `best` | bspline, `best`, coefficients too | linear, `best` |"
    print "| --- | --- | --- | --- | --- | --- |"
    for (i = 1; i <= count; i++) {
        s = sizes[i]
        printf "| %s | %s | %s | %s | %s | %s |\n", s, pre[s " cardinal rival"], pre[s " cardinal hull"], pre[s " cardinal best"], pre[s " bspline best"], pre[s " linear best"]
    }
    print "\nA new transfer function: tables, blocks and cells classified anew, milliseconds, the least of the rounds, the worst view:\n"
    print "| volume | cardinal, `best` | bspline, `best` |"
    print "| --- | --- | --- |"
    for (i = 1; i <= volumes; i++)
        printf "| %s | %.1f | %.1f |\n", order[i], change[order[i] " cardinal best"], change[order[i] " bspline best"]
    print "\nPictures that are not those of `none`, over five views: M + (M-m)/8, of one axis, and the safe bounds:\n"
    print "| volume | pixels by M + (M-m)/8 | farthest, of 1 | by `rival`, `hull`, `best`, both filters |"
    print "| --- | --- | --- | --- |"
    for (i = 1; i <= volumes; i++) {
        v = order[i] " "
        safe = 0
        for (key in differs)
            if (index(key, v) == 1 && key !~ /unsafe/) safe += differs[key]
        printf "| %s | %d | %.4f | %d |\n", order[i], differs[v "cardinal unsafe"], far[v "cardinal unsafe"], safe
    }
    if (!teems) exit
    print "\nBeside teem's mrender, the maximum of bonsai (256^3), 256x256 pixels, a sample a voxel, 2 threads, milliseconds:\n"
    print "| filter, view | dB | teem | `none` | `best` | teem/none | teem/best |"
    print "| --- | --- | --- | --- | --- | --- | --- |"
    for (i = 1; i <= teems; i++) print teem[i]
}
