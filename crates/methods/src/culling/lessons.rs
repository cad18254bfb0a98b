//! The methods of this question, explained.

use crate::lesson::Lesson;

pub(crate) const LESSONS: &[Lesson] = &[
    Lesson::new(
        "none",
        "All faces are drawn.",
        "Nothing is lost but time; see-through faces are blended in the order of the mesh.",
        "Vulkan: Basic Polygon Rasterization",
    ),
    Lesson::new(
        "back",
        "Faces that look away are culled by their winding.",
        "Right for closed meshes seen from outside; of open and mirrored ones, and from inside, parts are missing.",
        "Foley and others 1990, Computer Graphics: Principles and Practice, 15.4",
    ),
    Lesson::new(
        "front",
        "Faces that look at the eye are culled.",
        "Right from the inside of a closed mesh only.",
        "Vulkan: Basic Polygon Rasterization",
    ),
    Lesson::new(
        "back-flipped",
        "Back faces are culled, and the front face is turned over where a transform mirrors.",
        "Someone has to know which transforms mirror.",
        "OpenGL 4.6: 14.6.1",
    ),
    Lesson::new(
        "front-then-back",
        "Back faces are blended first, then front faces.",
        "The right order for one convex solid; of several or hollow ones no more than a good guess.",
        "McReynolds and Blythe 2005, Advanced Graphics Programming Using OpenGL",
    ),
    Lesson::new(
        "frustum",
        "Objects outside of the view are not drawn.",
        "Nothing is lost as long as bounds hold what they bound.",
        "Clark 1976, Hierarchical Geometric Models for Visible Surface Algorithms",
    ),
];
