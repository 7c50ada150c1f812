# SPDX-License-Identifier: Apache-2.0
"""State files, several views, selections and messages of the plug-in for ParaView."""
import os
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from stage import COLORS, OPACITIES, OURS, UNIT, StageTest, simple, table_of
from paraview import smstate


class Views(StageTest):
    def wavelet(self):
        source = simple.Wavelet(registrationName="Wavelet1", WholeExtent=[-8, 10, -7, 7, -6, 8])
        source.UpdatePipeline()
        return source, self.show(source, "RTData")

    def test_state_file(self):
        _, display = self.wavelet()
        display.Tolerance, display.Grade, display.Threads = 0.01, "Proved", 2
        before = self.picture()
        simple.SaveState(self.path("state.pvsm"))
        simple.ResetSession()
        simple.LoadPlugin(os.environ["PELLUCID_PARAVIEW_PLUGIN"], remote=False, ns=globals())
        simple.LoadState(self.path("state.pvsm"))
        self.view = simple.GetActiveView()
        display = simple.GetDisplayProperties(simple.FindSource("Wavelet1"), self.view)
        self.assertEqual(display.Representation, OURS)
        self.assertEqual((display.Tolerance, display.Grade, display.Threads), (0.01, "Proved", 2))
        self.assertEqual(abs(self.picture() - before).max(), 0)

    def test_python_state(self):
        _, display = self.wavelet()
        display.Tolerance = 0.01
        before = self.picture()
        lines = smstate.get_state()
        self.assertIn(".Tolerance = 0.01", lines)
        self.write("state.py", lines)
        simple.ResetSession()
        simple.LoadPlugin(os.environ["PELLUCID_PARAVIEW_PLUGIN"], remote=False, ns=globals())
        simple.LoadState(self.path("state.py"))
        self.view = simple.GetActiveView()
        self.assertEqual(abs(self.picture() - before).max(), 0)

    def test_two_views(self):
        source, _ = self.wavelet()
        layer = {"field": self.field_of(source, "RTData"),
                 "transfer_function": table_of(COLORS, OPACITIES, UNIT)}
        first = self.view
        self.assert_same([layer])
        self.view = self.new_view()
        self.view.CameraPosition = [-50, 10, 20]
        display = self.show(source, "RTData")
        display.Tolerance = 1e-4
        self.assert_same([layer], 1e-4)
        self.view = first
        self.assert_same([layer])

    def test_large_screenshots(self):
        """A screenshot larger than the window is one picture."""
        source, _ = self.wavelet()
        self.size = (240, 160)
        self.assert_same([{"field": self.field_of(source, "RTData"),
                           "transfer_function": table_of(COLORS, OPACITIES, UNIT)}])

    def test_selection_takes_what_is_behind(self):
        source, display = self.wavelet()
        sphere = simple.Sphere(Center=[1, 2, 0], Radius=2)
        simple.Show(sphere, self.view)
        simple.Render(self.view)
        simple.SelectSurfaceCells(Rectangle=[44, 28, 52, 36], View=self.view)
        self.assertIsNotNone(sphere.GetSelectionInput(0))
        self.assertIsNone(source.GetSelectionInput(0))

    def messages(self, script):
        """What another pvpython says that runs these lines after the volume is there."""
        lines = f"""
import sys
from paraview import simple
simple.LoadPlugin({os.environ["PELLUCID_PARAVIEW_PLUGIN"]!r}, remote=False, ns=globals())
source = simple.Wavelet()
view = simple.CreateView("RenderView")
display = simple.Show(source, view)
{script}
simple.Render(view)
simple.Render(view)
"""
        self.write("lines.py", lines)
        result = subprocess.run(["pvpython", self.path("lines.py")], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True, check=False)
        return result.stdout

    def test_without_an_array(self):
        said = self.messages(f"display.ColorArrayName = [None, '']\n"
                             f"display.Representation = {OURS!r}")
        self.assertEqual(said.count("choose one to color by"), 1, said)

    def test_functions_of_two_variables(self):
        said = self.messages(f"""display.SetRepresentationType({OURS!r})
simple.ColorBy(display, ("POINTS", "RTData"))
display.UseTransfer2D = 1""")
        self.assertEqual(said.count("functions of two variables"), 1, said)

    def test_nothing_is_said_otherwise(self):
        said = self.messages(f"""display.SetRepresentationType({OURS!r})
simple.ColorBy(display, ("POINTS", "RTData"))""")
        self.assertNotIn("ellucid", said)


if __name__ == "__main__":
    # Debian's pvpython crashes in sys.exit().
    unittest.main(argv=["test_views"], exit=False)
