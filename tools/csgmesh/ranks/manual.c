/* SPDX-License-Identifier: MIT
 * Help and page of csgmesh-mpi; see manual.h. Options are those of csgmesh mesh but for a few.
 */
#include "ranks/manual.h"

#include <stdio.h>
#include <string.h>

#include "csgmesh/csgmesh.h"
#include "manual/page.h"

static const cli_option_id refused[] = {
    CLI_OPTION_watch,   CLI_OPTION_lod,       CLI_OPTION_cells, CLI_OPTION_depfile,
    CLI_OPTION_trace,   CLI_OPTION_smooth,    CLI_OPTION_roots, CLI_OPTION_sandbox,
    CLI_OPTION_summary, CLI_OPTION_stats_full};
enum { REFUSED = sizeof refused / sizeof *refused };

static bool is_refused(cli_option_id option)
{
    for (int i = 0; i < REFUSED; i++)
        if (refused[i] == option)
            return true;
    return false;
}

static const char *name_of(cli_option_id option)
{
    const cli_option_row *row = NULL;
    while ((row = cli_next_option(CLI_MESH, row)) && (row->section || row->id != option))
        ;
    return row ? row->name : "";
}

int cli_ranks_refuse_options(cli_app *app)
{
    const cli_options *o = app->options;
    for (int i = 0; i < REFUSED; i++)
        if (o->given[refused[i]])
            return cli_usage_error(app, "csgmesh has it", "csgmesh-mpi has no --%s",
                                   name_of(refused[i]));
    return CLI_DONE;
}

void cli_ranks_tell_version(const char *library)
{
    printf("csgmesh-mpi %s\n%s\nwith %s\n", csgm_version(), csgm_build_features(), library);
}

static const char USAGE[] = "mpirun -n RANKS csgmesh-mpi SCENE -o FILE [options]";

void cli_ranks_tell_help(void)
{
    printf(
        "usage: %s\n\n"
        "Makes one mesh with many processes; the file has the bytes that csgmesh SCENE -o FILE\n"
        "writes with the same options. Equal cells (-r, -s) are shared out with their memory, and\n"
        "PLY, STL and GLB of one part are written by all ranks; of cells that follow the shape,\n"
        "and of meshes that are thinned out or improved, the work is shared out, and each rank\n"
        "has the whole mesh. Options are those of csgmesh mesh (csgmesh mesh --help) but for\n"
        "drawings, --lod, --cells, --depfile, --trace, --stats-full, --watch and --root. A rank\n"
        "has one thread unless -j says otherwise. --stats has the share of each rank. --resume\n"
        "keeps what is finished of equal cells in FILE.resume and goes on with what a job that\n"
        "was stopped has kept there. --man prints the page of the manual.\n",
        USAGE);
}

void cli_ranks_tell_page(void)
{
    cli_page_head("csgmesh-mpi", "one mesh by many processes, with the bytes of one");
    puts(".SH SYNOPSIS\n.B mpirun \\-n\n.I RANKS\n.B csgmesh\\-mpi\n.I SCENE\n.B "
         "\\-o\n.I FILE\n.RI [ options ]\n.SH DESCRIPTION");
    cli_page_line("The ranks of an MPI job, on one machine or many, make one mesh together. The "
                  "file has the bytes that csgmesh writes with the same options, whatever the "
                  "number of ranks. One file is written, by its name.");
    puts(".PP");
    cli_page_line("Of equal cells (-r, -s) each rank makes a share. PLY, STL and GLB of scenes "
                  "without parts and materials are written by all ranks at their final places, and "
                  "no rank has the mesh in memory; everything else is gathered by the first rank, "
                  "which writes it.");
    puts(".PP");
    cli_page_line("Of cells that follow the shape (without -r and -s, as with --quality, "
                  "--triangles, -e), and of meshes that are thinned out or improved (--simplify, "
                  "--improve), the work is shared out and the mesh is not: each rank needs the "
                  "memory of one process. The first rank writes the file.");
    puts(".PP");
    cli_page_line("All ranks read the scene and must see the folder of the output. Limits of time "
                  "and memory are each rank's own, and a rank has one thread unless -j says "
                  "otherwise. A rank that fails ends the job with one message and no file. --stats "
                  "has the share of each rank: cubes, tasks, triangles, processor time, memory, "
                  "bytes received.");
    cli_page_examples(
        "  mpirun -n 8 csgmesh-mpi lattice.txt -r 4096 -o lattice.ply\n"
        "  mpirun -n 8 csgmesh-mpi lattice.txt --quality fine -o lattice.3mf\n"
        "  mpirun -n 64 csgmesh-mpi lattice.txt -s 0.01 -o lattice.stl --max-memory 2G\n"
        "  srun csgmesh-mpi lattice.txt -r 8192 -o lattice.ply --stats=shares.json\n");
    puts(".SH OPTIONS\nThose of\n.BR csgmesh\\-mesh (1)\nthat make one mesh:");
    for (const cli_option_row *row = NULL; (row = cli_next_option(CLI_MESH, row));)
        if (!row->section && !is_refused(row->id))
            cli_page_option(CLI_MESH, row);
    puts(".PP\nAnd its own:\n.TP\n.B \\-\\-resume\nkeep "
         "what is finished of equal cells in the folder\n.IR FILE .resume,\nand go on with what an "
         "earlier job "
         "of the same command line has kept\nthat was stopped; a job that is done removes the "
         "folder\n.TP\n.B \\-\\-man\nprint this page");
    cli_page_status("done", "the input is at fault");
    puts(".SH \"SEE ALSO\"\n.BR csgmesh (1),\n.BR csgmesh\\-mesh (1),\n.BR mpirun (1)");
}
