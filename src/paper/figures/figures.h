#pragma once
// One function per figure of the paper.

#include "paper/workshop.h"

namespace umov {

Result<PaperFigure> make_fig1(PaperWorkshop &);
Result<PaperFigure> make_fig2(PaperWorkshop &);
Result<PaperFigure> make_fig3(PaperWorkshop &);
Result<PaperFigure> make_fig4(PaperWorkshop &);
Result<PaperFigure> make_fig5(PaperWorkshop &);
Result<PaperFigure> make_fig6(PaperWorkshop &);
Result<PaperFigure> make_fig7(PaperWorkshop &);
Result<PaperFigure> make_fig8(PaperWorkshop &);
Result<PaperFigure> make_fig9(PaperWorkshop &);
Result<PaperFigure> make_fig10(PaperWorkshop &);
Result<PaperFigure> make_fig11(PaperWorkshop &);
Result<PaperFigure> make_fig12(PaperWorkshop &);
Result<PaperFigure> make_fig13(PaperWorkshop &);
Result<PaperFigure> make_fig14(PaperWorkshop &);
Result<PaperFigure> make_fig15(PaperWorkshop &);
Result<PaperFigure> make_fig16(PaperWorkshop &);
Result<PaperFigure> make_fig17(PaperWorkshop &);
Result<PaperFigure> make_fig18(PaperWorkshop &);
Result<PaperFigure> make_fig19(PaperWorkshop &);
Result<PaperFigure> make_fig20(PaperWorkshop &);
Result<PaperFigure> make_fig21(PaperWorkshop &);
Result<PaperFigure> make_fig22(PaperWorkshop &);
Result<PaperFigure> make_fig23(PaperWorkshop &);
Result<PaperFigure> make_fig24(PaperWorkshop &);
Result<PaperFigure> make_table1(PaperWorkshop &);

} // namespace umov
