/* SPDX-License-Identifier: MIT
 * Help and page of csgmesh-mpi; see manual.h. Options are those of csgmesh mesh but for a few.
 */
#include "ranks/manual.h"

#include <stdio.h>
#include <string.h>

#include "csgmesh/csgmesh.h"
#include "manual/page.h"

typedef enum refusal { OTHERS_HAVE_IT, CHANGES_TRIANGLES } refusal;

static const struct {
    cli_option_id option;
    refusal why;
} refused[] = {{CLI_OPTION_watch, OTHERS_HAVE_IT},        {CLI_OPTION_lod, OTHERS_HAVE_IT},
               {CLI_OPTION_cells, OTHERS_HAVE_IT},        {CLI_OPTION_depfile, OTHERS_HAVE_IT},
               {CLI_OPTION_trace, OTHERS_HAVE_IT},        {CLI_OPTION_smooth, OTHERS_HAVE_IT},
               {CLI_OPTION_roots, OTHERS_HAVE_IT},        {CLI_OPTION_sandbox, OTHERS_HAVE_IT},
               {CLI_OPTION_summary, OTHERS_HAVE_IT},      {CLI_OPTION_stats_full, OTHERS_HAVE_IT},
               {CLI_OPTION_tolerance, CHANGES_TRIANGLES}, {CLI_OPTION_quality, CHANGES_TRIANGLES},
               {CLI_OPTION_triangles, CHANGES_TRIANGLES}, {CLI_OPTION_simplify, CHANGES_TRIANGLES},
               {CLI_OPTION_improve, CHANGES_TRIANGLES}};
enum { REFUSED = sizeof refused / sizeof *refused };

static bool is_refused(cli_option_id option)
{
    for (int i = 0; i < REFUSED; i++)
        if (refused[i].option == option)
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
    for (int i = 0; i < REFUSED; i++) {
        if (!o->given[refused[i].option])
            continue;
        if (refused[i].why == OTHERS_HAVE_IT)
            return cli_usage_error(app, "csgmesh has it", "csgmesh-mpi has no --%s",
                                   name_of(refused[i].option));
        return cli_usage_error(app, "csgmesh does that, in one process",
                               "csgmesh-mpi changes none of the triangles that equal cells give: "
                               "--%s is not for it",
                               name_of(refused[i].option));
    }
    return CLI_DONE;
}

void cli_ranks_tell_version(const char *library)
{
    printf("csgmesh-mpi %s\n%s\nwith %s\n", csgm_version(), csgm_build_features(), library);
}

static const char USAGE[] = "mpirun -n RANKS csgmesh-mpi SCENE -r CELLS -o FILE [options]";

void cli_ranks_tell_help(void)
{
    printf(
        "usage: %s\n\n"
        "Makes one mesh of equal cells with many processes; the file has the bytes that\n"
        "csgmesh SCENE -r CELLS -o FILE writes. PLY, STL and GLB of one part are written by\n"
        "all ranks. Options are those of csgmesh mesh (csgmesh mesh --help) but for what\n"
        "changes triangles (-e, --quality, --triangles, --simplify, --improve), drawings,\n"
        "--lod, --cells, --depfile, --trace, --watch and --root. A rank has one thread unless\n"
        "-j says otherwise. --stats has the share of each rank. --resume keeps what is finished\n"
        "in FILE.resume and goes on with what a job that was stopped has kept there. --man\n"
        "prints the page of the manual.\n",
        USAGE);
}

void cli_ranks_tell_page(void)
{
    cli_page_head("csgmesh-mpi",
                  "one mesh of equal cells by many processes, with the bytes of one");
    puts(
        ".SH SYNOPSIS\n.B mpirun \\-n\n.I RANKS\n.B csgmesh\\-mpi\n.I SCENE\n.B \\-r\n.I CELLS\n.B "
        "\\-o\n.I FILE\n.RI [ options ]\n.SH DESCRIPTION");
    cli_page_line("The ranks of an MPI job, on one machine or many, make one mesh of equal cells "
                  "together. The file has the bytes that csgmesh writes, whatever the number of "
                  "ranks. PLY, STL and GLB of scenes without parts and materials are written by "
                  "all ranks at their final places, and no rank has the mesh in memory; "
                  "everything else is gathered by the first rank, which writes it. One file is "
                  "written, by its name.");
    puts(".PP");
    cli_page_line("All ranks read the scene and must see the folder of the output. Limits of time "
                  "and memory are each rank's own, and a rank has one thread unless -j says "
                  "otherwise. A rank that fails ends the job with one message and no file. --stats "
                  "has the share of each rank: cubes, triangles, processor time, memory, bytes "
                  "received.");
    cli_page_examples(
        "  mpirun -n 8 csgmesh-mpi lattice.txt -r 4096 -o lattice.ply\n"
        "  mpirun -n 64 csgmesh-mpi lattice.txt -s 0.01 -o lattice.stl --max-memory 2G\n"
        "  srun csgmesh-mpi lattice.txt -r 8192 -o lattice.ply --stats=shares.json\n");
    puts(".SH OPTIONS\nThose of\n.BR csgmesh\\-mesh (1)\nthat do not change triangles after they "
         "are "
         "made:");
    for (const cli_option_row *row = NULL; (row = cli_next_option(CLI_MESH, row));)
        if (!row->section && !is_refused(row->id))
            cli_page_option(CLI_MESH, row);
    puts(".PP\nAnd its own:\n.TP\n.B \\-\\-resume\nkeep "
         "what is finished in the folder\n.IR FILE .resume,\nand go on with what an earlier job "
         "of the same command line has kept\nthat was stopped; a job that is done removes the "
         "folder\n.TP\n.B \\-\\-man\nprint this page");
    cli_page_status("done", "the input is at fault");
    puts(".SH \"SEE ALSO\"\n.BR csgmesh (1),\n.BR csgmesh\\-mesh (1),\n.BR mpirun (1)");
}
