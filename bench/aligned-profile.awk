# aligned-profile.awk - a profile of `aligned_frames launches` by ncu, as lines of JSON for a record: a launch of the kernel each,
# in the order in which the program names them. ncu's lines are quoted fields: the launch's number first, then, third and
# second from last, metric and unit, last the value.
function value(name,    text) {
    if (!match($0, "\"" name "\": (\"[^\"]*\"|[^,}]*)")) return ""
    text = substr($0, RSTART + length(name) + 4, RLENGTH - length(name) - 4)
    gsub(/"/, "", text)
    return text
}
/"result": "aligned_launch"/ { volume = value("volume"); view[value("number")] = value("view"); way[value("number")] = value("way"); next }
/^"[0-9]+",/ {
    line = $0
    sub(/^"/, "", line); sub(/"$/, "", line)
    n = split(line, field, /","/)
    number = field[n]; gsub(/,/, "", number)
    metric[field[1] "|" field[n - 2]] = number
    if (!(field[1] in seen)) { seen[field[1]] = 1; order[++launches] = field[1] }
}
END {
    for (i = 1; i <= launches; i++) {
        id = order[i] "|"
        if (!((i - 1) in way)) continue
        printf "{\"result\": \"aligned_profile\", \"volume\": \"%s\", \"view\": \"%s\", \"way\": \"%s\", \"sectors_per_request\": %.2f, \"l1_hit\": %.1f, \"l2_hit\": %.1f, \"dram_mb\": %.1f, \"us\": %.1f}\n",
            volume, view[i - 1], way[i - 1], metric[id "l1tex__average_t_sectors_per_request_pipe_lsu_mem_global_op_ld.ratio"],
            metric[id "l1tex__t_sector_hit_rate.pct"], metric[id "lts__t_sector_hit_rate.pct"], metric[id "dram__bytes_read.sum"] / 1e6,
            metric[id "gpu__time_duration.sum"] / 1e3
    }
}
